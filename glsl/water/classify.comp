#version 460
// Pass `classify`: decides which particles of the water foam, by Weber number (inertia over surface tension; thesis
// Sec. 3.2). Each particle's state is looked up by id in the hash table of the previous step, advanced, and entered
// in the table of this step. So the order of the particles does not matter, and ids that have vanished are forgotten.
// A dispatch binds one part of each table and handles the particles whose ids belong there.
// Reads: velocities, densities, ids, the host's count, the old table. Writes: the new table, foam.

#include "random.glsl"

layout(local_size_x = 64) in;

// A row of the hash tables: a particle's state. The key is its id + 1, or 0 for an empty row.
struct Row {
    uint key;
    uint phase; // phase in the lowest two bits, number of transitions above
    float timer;
    float lifetime;
    float age;
};

layout(set = 0, binding = 1, std430) readonly buffer Velocities { float velocities[]; };
layout(set = 0, binding = 2, std430) readonly buffer Densities { float densities[]; };
layout(set = 0, binding = 3, std430) readonly buffer Ids { uint ids[]; };
layout(set = 0, binding = 4, std430) readonly buffer HostCount { uint host_count; };
layout(set = 0, binding = 5, std430) readonly buffer Old { Row old_rows[]; };
layout(set = 0, binding = 6, std430) buffer New { Row new_rows[]; };
// Output: the foam (0 to 1) and its age, for each particle of the chunk, in the order of the step's streams.
layout(set = 0, binding = 7, std430) writeonly buffer Foam { vec2 foam[]; };

layout(push_constant, std430) uniform Push {
    uint velocity_word;   // of the chunk's first particle
    uint velocity_stride; // in words
    uint density_word;
    uint density_stride;  // 0: no densities
    uint id_word;
    uint id_stride;       // 0: no ids
    uint first;           // particle of the chunk
    uint count;           // most particles
    uint from_gpu;        // 1: the host's buffer holds the number, at most count
    uint chunk_end;       // first particle of the next chunk
    uint rows;            // of all parts
    uint part_first;      // row of the part
    uint part_rows;
    uint seed;
    float scale;          // Weber number per density and squared speed
    float threshold;
    float foam_lifetime;
    float dt;
    float air_x;
    float air_y;
    float air_z;
    float rest_density;
} push;

const uint WATER = 0u;
const uint WATER_TO_FOAM = 1u;
const uint FOAM = 2u;
const uint FOAM_TO_WATER = 3u;

// `precise`: the CPU twin must reach the same phases, bit for bit.
float weber(uint i) {
    uint at = push.velocity_word + i * push.velocity_stride;
    precise float x = velocities[at] - push.air_x;
    precise float y = velocities[at + 1u] - push.air_y;
    precise float z = velocities[at + 2u] - push.air_z;
    precise float square = (x * x + y * y) + z * z;
    float density = push.density_stride > 0u ? densities[push.density_word + i * push.density_stride] : 0.0;
    // A density of 0 marks a particle that was just emitted and has no density yet: it gets the rest density. So does
    // NaN, because comparisons with it are false.
    density = density > 0.0 ? density : push.rest_density;
    precise float number = (density * square) * push.scale;
    return number;
}

// Row of the bound part at which the search for a key begins; outside the part if the key belongs to another part.
uint slot_of(uint key) {
    uint high;
    uint low;
    umulExtended(pcg(key), push.rows, high, low);
    return high - push.part_first;
}

// Max length of a search in rows. In a table that is two thirds full no search takes a quarter of this. Without the
// limit, ids chosen to collide, or a corrupt table, would make each search visit all rows. A particle that finds no
// row starts as new water in each step.
const uint MOST_LOOKS = 1024u;

// The search wraps around at the end of the part.
uint next(uint slot) {
    return slot + 1u == push.part_rows ? 0u : slot + 1u;
}

// The particle's row of the previous step; a new particle is water.
Row row_before(uint key, uint slot) {
    for (uint n = 0u; n < min(push.part_rows, MOST_LOOKS) && old_rows[slot].key != 0u; ++n) {
        if (old_rows[slot].key == key) {
            Row row = old_rows[slot];
            row.age += push.dt;
            return row;
        }
        slot = next(slot);
    }
    return Row(key, WATER, 0.0, 0.0, 0.0);
}

void enter(Row row, uint slot) {
    for (uint n = 0u; n < min(push.part_rows, MOST_LOOKS); ++n) {
        uint there = atomicCompSwap(new_rows[slot].key, 0u, row.key);
        if (there == 0u) {
            new_rows[slot].phase = row.phase;
            new_rows[slot].timer = row.timer;
            new_rows[slot].lifetime = row.lifetime;
            new_rows[slot].age = row.age;
            return;
        }
        // A second particle with the same id: the first one keeps the row.
        if (there == row.key) {
            return;
        }
        slot = next(slot);
    }
}

// Advances a row by one step and returns the particle's foam, 0 to 1.
float advance(inout Row row, uint id, float number) {
    uint transitions = row.phase >> 2;
    uint phase = row.phase & 3u;
    float foam_now = 0.0;
    bool foaming = number >= push.threshold;
    if (phase == WATER) {
        if (foaming) {
            precise float lifetime = 0.25 + 0.25 * uniform_of(push.seed, id, transitions);
            row.lifetime = lifetime;
            row.timer = lifetime;
            row.phase = ((transitions + 1u) << 2) | WATER_TO_FOAM;
        }
    } else if (phase == FOAM) {
        foam_now = 1.0;
        if (!foaming) {
            precise float lifetime = push.foam_lifetime * (0.5 + uniform_of(push.seed, id, transitions));
            row.lifetime = lifetime;
            row.timer = lifetime;
            row.phase = ((transitions + 1u) << 2) | FOAM_TO_WATER;
        }
    } else {
        precise float timer = row.timer - push.dt;
        row.timer = timer;
        bool to_foam = phase == WATER_TO_FOAM;
        if (timer <= 0.0) {
            row.phase = (transitions << 2) | (to_foam ? FOAM : WATER);
            foam_now = to_foam ? 1.0 : 0.0;
        } else {
            float left = timer / row.lifetime;
            foam_now = to_foam ? 1.0 - left : left;
        }
    }
    return foam_now;
}

void main() {
    uint i = gl_GlobalInvocationID.x;
    uint particle = push.first + i;
    uint count = push.from_gpu == 1u ? min(host_count, push.count) : push.count;
    if (particle >= min(count, push.chunk_end)) {
        return;
    }
    if (push.id_stride == 0u) {
        // Without ids no state can be kept, so the foam follows from the Weber number alone: 0 up to half the
        // threshold, then linear up to 1 at one and a half times the threshold; for NaN it is 0, because comparisons
        // with NaN are false.
        float ramp = weber(i) / push.threshold - 0.5;
        foam[i] = vec2(ramp > 0.0 ? min(ramp, 1.0) : 0.0, 0.0);
        return;
    }
    uint id = ids[push.id_word + i * push.id_stride];
    uint key = id + 1u;
    uint slot = slot_of(key);
    if (slot >= push.part_rows) {
        return;
    }
    if (key == 0u) {
        foam[i] = vec2(0.0);
        return;
    }
    Row row = row_before(key, slot);
    float now = advance(row, id, weber(i));
    enter(row, slot);
    foam[i] = vec2(now, row.age);
}
