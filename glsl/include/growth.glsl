// Growth or shrinking of a blob that is one half of a split blob: one half shrinks to its goal, the other grows from
// nothing. Needs nothing.

struct Growth {
    float goal;   // final radius after the halves have separated
    float parted; // progress of the separation, 0 to 1
    float alone;  // seconds with too few neighbours
    uint halved;  // number of splits; with CHILD: this is the half that grows
};

const uint CHILD = 0x100u;

// At any time both halves together have the volume of the whole.
float radius_of(Growth growth) {
    float p = growth.parted;
    float whole = p < 1.0 ? pow(2.0 - p * p * p, 1.0 / 3.0) : 1.0;
    return growth.goal * ((growth.halved & CHILD) != 0u ? p : whole);
}
