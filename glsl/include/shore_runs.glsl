// Tiles of 8x8 pixels next to each other in a row, in one word: the first, and how many there are.

const uint LONGEST = 16u;

uint run_of(uint first, uint tiles) {
    return first | (tiles - 1u) << 28;
}

uint first_of_run(uint run) {
    return run & 0x0fffffffu;
}

uint tiles_of_run(uint run) {
    return 1u + (run >> 28);
}
