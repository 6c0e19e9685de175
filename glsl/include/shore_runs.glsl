// A run of adjacent tiles of 8x8 pixels in a row, in one word: the first tile (low 28 bits), and the number of tiles
// minus 1.

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
