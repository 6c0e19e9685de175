// Growth and shrinking of a blob that is one half of a split one. Needs nothing.

struct Growth {
    float goal;   // radius when they have parted
    float parted; // 0 to 1: they have
    float alone;  // seconds with too little beside it
    uint halved;  // how often; with CHILD: it is the half that grows
};

const uint CHILD = 0x100u;

// Both have the volume of the whole at every time.
float radius_of(Growth growth) {
    float p = growth.parted;
    float whole = p < 1.0 ? pow(2.0 - p * p * p, 1.0 / 3.0) : 1.0;
    return growth.goal * ((growth.halved & CHILD) != 0u ? p : whole);
}
