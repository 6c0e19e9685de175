#version 460
// Pass `heap`, move: forces on a blob and its motion (Huszar, Szecsi, Sec. 6; theirs runs on the CPU). The forces are
// attraction of near neighbours, repulsion of nearer ones, gravity and the push of solids. They derive from a
// potential and are damped, so with short enough steps the energy of a closed system decreases from step to step; they
// begin and end continuously. A blob with too few neighbours splits into two halves: one shrinks from the whole as the
// other grows.
// Reads: heaped, buckets, solids, field, turns, growths. Writes: balls, turns, ids, drifts, spins, growths.

#include "heap.glsl"
#include "growth.glsl"
#include "solid.glsl"
#include "quaternion.glsl"

layout(local_size_x = 64) in;

layout(set = 0, binding = 0, std430) writeonly buffer Balls { vec4 balls[]; };
layout(set = 0, binding = 1, std430) buffer Turns { vec4 turns[]; };
layout(set = 0, binding = 2, std430) writeonly buffer Ids { uint ids[]; };
layout(set = 0, binding = 3, std430) writeonly buffer Drifts { vec4 drifts[]; };
layout(set = 0, binding = 4, std430) writeonly buffer Spins { vec4 spins[]; };
layout(set = 0, binding = 5, std430) readonly buffer Buckets { uint buckets[]; };
layout(set = 0, binding = 7, std430) readonly buffer Heap { Heaped heaped[]; };
layout(set = 0, binding = 8, std430) readonly buffer Solids { Solid solids[]; };
layout(set = 0, binding = 9, std430) readonly buffer Field { float field[]; };
layout(set = 0, binding = 10, std430) buffer Growths { Growth growths[]; };

// Reciprocal of the factor 2/5 in a ball's moment of inertia.
const float ROUND = 2.5;

struct Pushed {
    vec3 speed; // acceleration
    vec3 spin;
};

// Force of another blob.
Pushed pushed_by(Heaped own, Heaped other) {
    Pushed none = Pushed(vec3(0.0), vec3(0.0));
    vec3 to = other.ball.xyz - own.ball.xyz;
    float sum = own.ball.w + other.ball.w;
    float far = length(to);
    float rest = push.pair.x * sum;
    float reach = push.pair.y * sum;
    if (far >= reach) {
        return none;
    }
    // If two blobs lie in one place, the one with the lower id is pushed up (+y), the other one down.
    bool lower = floatBitsToUint(own.drift.w) < floatBitsToUint(other.drift.w);
    vec3 n = far > 1.0e-6 * sum ? to / far : vec3(0.0, lower ? -1.0 : 1.0, 0.0);
    float part = (reach - far) / (reach - rest);
    float pull = 4.0 * part * (1.0 - part) * push.pair.w;
    float along = far < rest ? push.pair.z * (far - rest) : pull;
    vec3 slip = other.drift.xyz - own.drift.xyz
        - cross(other.spin.xyz, other.ball.w * n) - cross(own.spin.xyz, own.ball.w * n);
    float parting = dot(slip, n);
    float near = min(part, 1.0);
    vec3 across = push.damping.y * near * (slip - parting * n);
    // The forces on the two blobs are equal and opposite, with the factor 2ab / (a + b) of their masses a (own) and
    // b. `share` is this factor divided by the own mass.
    float a = own.ball.w * own.ball.w * own.ball.w;
    float b = other.ball.w * other.ball.w * other.ball.w;
    float share = 2.0 * b / (a + b);
    return Pushed(share * ((along + push.damping.x * near * parting) * n + across),
                  share * ROUND / own.ball.w * cross(n, across));
}

// xyz: direction out of a solid; w: distance from it. On a mid-plane of a box both sides are equally near; the positive
// one is taken, so that no blob stays inside.
vec4 solid_at(Solid solid, vec3 place) {
    if (solid.place.w < 0.5) {
        return vec4(solid.place.xyz, dot(solid.place.xyz, place) - solid.size.w);
    }
    vec3 q = turned(turned_back(solid.turn), place - solid.place.xyz);
    vec3 d = abs(q) - solid.size.xyz;
    vec3 out_ = max(d, 0.0);
    float beside = length(out_);
    float most = max(d.x, max(d.y, d.z));
    vec3 face = vec3(d.x >= most, d.x < most && d.y >= most, d.x < most && d.y < most);
    vec3 side = mix(vec3(1.0), vec3(-1.0), lessThan(q, vec3(0.0)));
    vec3 n = side * (beside > 0.0 ? out_ / beside : face);
    return vec4(turned(solid.turn, n), beside > 0.0 ? beside : most);
}

// Like solid_at, for the solids in the distance field: xyz is the direction out of them (the field's gradient), w the
// distance from them (its value), both interpolated. Outside of the field's box there is no solid.
vec4 field_at(vec3 place) {
    vec3 at = (place - push.field.xyz) / push.field.w;
    vec3 last = vec3(push.field_size.xyz) - 1.0;
    if (any(lessThan(at, vec3(0.0))) || any(greaterThan(at, last))) {
        return vec4(0.0, 1.0, 0.0, 1.0e10);
    }
    uvec3 base = uvec3(min(at, last - 1.0));
    vec3 f = at - vec3(base);
    vec4 sum = vec4(0.0);
    for (uint i = 0u; i < 8u; ++i) {
        uvec3 side = uvec3(i & 1u, i >> 1 & 1u, i >> 2);
        uvec3 point = base + side;
        float d = field[(point.z * push.field_size.y + point.y) * push.field_size.x + point.x];
        vec3 part = mix(1.0 - f, f, vec3(side));
        vec3 grows = 2.0 * vec3(side) - 1.0;
        sum.w += d * part.x * part.y * part.z;
        sum.xyz += d * grows * vec3(part.y * part.z, part.x * part.z, part.x * part.y);
    }
    float steep = length(sum.xyz);
    return vec4(steep > 0.0 ? sum.xyz / steep : vec3(0.0, 1.0, 0.0), sum.w);
}

// Applies the contact with a solid (xyz: direction out of it, w: distance) to the speed and spin of a blob (centre,
// radius). The solid pushes in proportion to the penetration; friction is at most proportional to the push.
void touch(vec4 solid, vec4 ball, inout vec3 speed, inout vec3 spin) {
    float deep = push.solid.x * ball.w - solid.w;
    if (deep <= 0.0) {
        return;
    }
    vec3 n = solid.xyz;
    float dt = push.solid.z;
    float parting = dot(speed, n);
    float gained = max(dt * (push.solid.y * deep - push.damping.z * parting), 0.0);
    speed += gained * n;
    vec3 slip = speed - dot(speed, n) * n + cross(spin, -ball.w * n);
    slip -= dot(slip, n) * n;
    float fast = length(slip);
    // Friction takes at most so much speed that the contact point stops sliding; the blob then rolls.
    float held = min(push.damping.w * gained, fast / (1.0 + ROUND));
    vec3 change = fast > 0.0 ? -held / fast * slip : vec3(0.0);
    speed += change;
    spin += ROUND / ball.w * cross(-n, change);
}

// What touches a blob. `volume`: that of the touching neighbours, as radius cubed; `lean`: direction towards
// neighbours and solids, weighted by volume; `ground`: direction out of the last solid touched.
struct Company {
    float volume;
    vec3 lean;
    vec3 ground;
};

float volume_of(float radius) {
    return radius * radius * radius;
}

void beside(inout Company company, Heaped own, Heaped other) {
    vec3 to = other.ball.xyz - own.ball.xyz;
    float reach = push.pair.y * (own.ball.w + other.ball.w);
    float square = dot(to, to);
    if (square < reach * reach) {
        float volume = volume_of(other.ball.w);
        company.volume += volume;
        company.lean += volume * inversesqrt(max(square, 1.0e-20)) * to;
    }
}

void lies_on(inout Company company, Heaped own, vec4 solid) {
    if (solid.w < own.ball.w) {
        company.lean -= volume_of(own.ball.w) * solid.xyz;
        company.ground = solid.xyz;
    }
}

// Returns the direction from a splitting blob to the second half that grows beside it: random by the blob's id, but
// beside the neighbours, so that clumps form, and not into solids.
vec3 way_apart(Heaped own, Company company) {
    uint number = pcg(floatBitsToUint(own.drift.w) ^ 0x70617274u);
    float up = float(number >> 8) / 8388608.0 - 1.0;
    float round_ = float(pcg(number) >> 8) / 16777216.0 * 6.2831853;
    vec3 any_ = vec3(sqrt(max(1.0 - up * up, 0.0)) * vec2(cos(round_), sin(round_)), up);
    float far = length(company.lean);
    vec3 to = far > 0.0 ? company.lean / far : vec3(0.0);
    vec3 across = any_ - dot(any_, to) * to;
    // The second half is placed at about 65 degrees from the direction to the neighbours, so that both halves and a
    // neighbour of the same size touch each other.
    vec3 way = across / max(length(across), 0.01) + 0.45 * to;
    way -= 2.0 * min(dot(way, company.ground), 0.0) * company.ground;
    return way / max(length(way), 0.01);
}

// Advances the growth of a blob's halves. A blob that has had too few neighbours for some time splits, at most as
// often as there are entries for its halves. A step of (almost) no time begins no split: the second half would get no
// radius, and blobs without one never grow. Returns the blob's radius after the step.
float grown(Heaped own, uint index, Company company, vec3 place, vec3 speed, vec3 spin) {
    float dt = push.solid.z;
    Growth growth = growths[index];
    uint halved = growth.halved & 0xffu;
    if (growth.parted < 1.0) {
        growth.parted = min(growth.parted + dt / push.solid.w, 1.0);
    } else if (halved < push.max_splits) {
        bool kept = company.volume >= push.water.z * volume_of(own.ball.w);
        growth.alone = kept ? 0.0 : growth.alone + dt;
        if (growth.alone > push.water.w && dt > 1.0e-9 * push.solid.w) {
            float goal = 0.79370053 * own.ball.w;
            growth = Growth(goal, min(dt / push.solid.w, 1.0), 0.0, halved + 1u);
            Growth other = Growth(goal, growth.parted, 0.0, (halved + 1u) | CHILD);
            uint at = index + ((push.blobs >> push.max_splits) << halved);
            float apart = push.pair.x * (radius_of(growth) + radius_of(other));
            balls[at] = vec4(place + apart * way_apart(own, company), radius_of(other));
            turns[at] = turns[index];
            ids[at] = pcg(pcg(floatBitsToUint(own.drift.w)) ^ (0x68616c66u + halved));
            drifts[at] = vec4(speed, 0.0);
            spins[at] = vec4(spin, 0.0);
            growths[at] = other;
        }
    }
    growths[index] = growth;
    return radius_of(growth);
}

void main() {
    uint k = gl_GlobalInvocationID.x;
    // Invalid blobs are not in the grid.
    if (k >= buckets[push.buckets - 1u]) {
        return;
    }
    Heaped own = heaped[k];
    Company company = Company(0.0, vec3(0.0), vec3(0.0));
    ivec3 cell = heap_cell(own.ball.xyz);
    Pushed sum = Pushed(vec3(0.0), vec3(0.0));
    for (int c = 0; c < 27; ++c) {
        ivec3 next = cell + ivec3(c % 3, c / 3 % 3, c / 9) - 1;
        uint bucket = bucket_of(next);
        uint j = bucket > 0u ? buckets[bucket - 1u] : 0u;
        uint end = min(buckets[bucket], j + MOST_IN_BUCKET);
        while (j < end) {
            Heaped other = heaped[j];
            // Several cells share a bucket.
            if (j != k && all(equal(heap_cell(other.ball.xyz), next))) {
                beside(company, own, other);
                Pushed by = pushed_by(own, other);
                sum = Pushed(sum.speed + by.speed, sum.spin + by.spin);
            }
            ++j;
        }
    }
    float dt = push.solid.z;
    // Up is against gravity, or along y without gravity.
    float pulled = length(push.gravity.xyz);
    float height = pulled > 0.0 ? -dot(own.ball.xyz, push.gravity.xyz) / pulled : own.ball.y;
    float wet = clamp((push.water.x - height + own.ball.w) / (2.0 * own.ball.w), 0.0, 1.0);
    vec3 pull = push.gravity.xyz * (1.0 - wet / push.water.y);
    vec3 speed = own.drift.xyz + dt * (sum.speed + pull);
    // Drag under water is 8 1/s, whatever the drag of air. Only the drag of air slows the spin.
    speed /= 1.0 + dt * mix(push.gravity.w, 8.0, wet);
    vec3 spin = (own.spin.xyz + dt * sum.spin) / (1.0 + dt * push.gravity.w);
    for (uint i = 0u; i < push.field_size.w; ++i) {
        vec4 solid = solid_at(solids[i], own.ball.xyz);
        lies_on(company, own, solid);
        touch(solid, own.ball, speed, spin);
    }
    if (push.field_size.x > 1u) {
        vec4 solid = field_at(own.ball.xyz);
        lies_on(company, own, solid);
        touch(solid, own.ball, speed, spin);
    }
    // A blob moves by at most its radius per step, so that it does not pass through anything.
    float most = own.ball.w / dt;
    speed *= min(most / max(length(speed), 1.0e-20), 1.0);
    uint index = floatBitsToUint(own.spin.w);
    vec4 turn = turns[index];
    vec3 half_ = 0.5 * dt * spin;
    turn += vec4(turn.w * half_ + cross(half_, turn.xyz), -dot(half_, turn.xyz));
    vec3 place = own.ball.xyz + dt * speed;
    float radius = push.max_splits > 0u ? grown(own, index, company, place, speed, spin) : own.ball.w;
    balls[index] = vec4(place, radius);
    turns[index] = normalize(turn);
    drifts[index] = vec4(speed, 0.0);
    spins[index] = vec4(spin, 0.0);
}
