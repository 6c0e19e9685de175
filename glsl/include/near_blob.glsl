// Which whitewater particles can become blobs of bubble foam. Needs frame.glsl, whitewater.glsl, crossfade.glsl,
// frustum.glsl.

// Whether a particle becomes a blob if there is a slot. Particles off the screen do not.
bool may_be_blob(Whitewater p, float distance_) {
    return p.kind == FOAM && p.life > 0.0 && ring_of(distance_) < RINGS
        && in_frustum(p.centre, frame.whitewater_light.w * p.radius);
}
