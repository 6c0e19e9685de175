// The host's packets of particles (thesis Sec. 4.3). The includer binds packets as eight words each: first particle,
// number of particles, min and max corner of the box of their centres. Reads: packets.

struct Packet {
    uint first; // first particle, in the chunk
    uint past;
    vec3 middle; // centre of its box in the world
    float reach; // radius of the box around it
};

// The part of a packet that lies in a chunk with `count` particles. The packet's own number of particles is clamped
// before the addition, so that the sum stays within 32 bits.
Packet packet_at(uint i, uint chunk_first, uint count) {
    uint at = 8u * i;
    uint first = max(packets[at], chunk_first);
    uint past = min(packets[at] + min(packets[at + 1u], ~packets[at]), chunk_first + count);
    vec3 low = uintBitsToFloat(uvec3(packets[at + 2u], packets[at + 3u], packets[at + 4u]));
    vec3 high = uintBitsToFloat(uvec3(packets[at + 5u], packets[at + 6u], packets[at + 7u]));
    Packet packet;
    packet.first = first - chunk_first;
    packet.past = max(past, first) - chunk_first;
    packet.middle = 0.5 * (low + high);
    packet.reach = 0.5 * length(high - low);
    return packet;
}
