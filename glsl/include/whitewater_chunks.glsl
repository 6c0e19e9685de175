// Number of whitewater particles in a chunk. Needs the push constants that it uses. Reads: count.

uint own_of(uint chunk) {
    uint all = push.from_gpu == 1u ? min(count, push.count) : push.count;
    return min(all - min(all, chunk * push.chunk_size), push.chunk_size);
}
