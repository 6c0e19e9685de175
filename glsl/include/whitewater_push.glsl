// Offsets and strides of a chunk's particle streams in pass `splat`, in 32-bit words. An absent stream has a stride
// of 0.

layout(push_constant, std430) uniform Push {
    uint position_word;
    uint position_stride;
    uint kind_word;
    uint kind_stride;
    uint radius_word;
    uint radius_stride;
    uint age_word;
    uint age_stride;
    uint id_word;
    uint id_stride;
    uint chunk_first;
    uint chunk;
} push;
