// Which whitewater particles can become blobs of bubble foam. Needs frame.glsl, whitewater.glsl, crossfade.glsl,
// frustum.glsl.

// Whether a whitewater particle becomes a blob of bubbles if a slot for one is free: it is living foam, on the
// screen, and near enough to the camera.
bool may_be_blob(Whitewater p, float distance_) {
    return p.kind == FOAM && p.life > 0.0 && ring_of(distance_) < RINGS
        && in_frustum(p.centre, frame.whitewater_light.w * p.radius);
}
