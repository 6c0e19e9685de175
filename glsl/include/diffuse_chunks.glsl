// How many whitewater particles there are in a chunk. Needs of the push constants what names them here. Reads: count.

uint own_of(uint chunk) {
    uint all = push.from_gpu == 1u ? min(count, push.count) : push.count;
    return min(all - min(all, chunk * push.chunk_size), push.chunk_size);
}
