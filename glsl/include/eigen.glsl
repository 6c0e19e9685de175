// Eigenvalues and eigenvectors of a symmetric matrix by a fixed number of Jacobi rotations (Golub and Van Loan 2013,
// Sec. 8.5), so that no matrix hangs a device. Needs nothing.

// One Jacobi rotation: rotates the axes p and q of a symmetric matrix so that its element a_pq becomes 0. It updates
// the elements pp, qq, pq, pr and qr, where r is the third axis.
void turn(inout float pp, inout float qq, inout float pq, inout float pr, inout float qr, inout vec3 p, inout vec3 q) {
    float d = qq - pp;
    // Tangent of the rotation angle: of the two angles that make a_pq 0, the smaller one. For a multiple of the
    // identity it is 0, not 0 / 0.
    float t = (d < 0.0 ? -2.0 : 2.0) * pq / max(abs(d) + sqrt(d * d + 4.0 * pq * pq), 1.0e-30);
    float c = inversesqrt(1.0 + t * t);
    float s = t * c;
    pp -= t * pq;
    qq += t * pq;
    pq = 0.0;
    vec2 off = vec2(c * pr - s * qr, s * pr + c * qr);
    pr = off.x;
    qr = off.y;
    vec3 turned = c * p - s * q;
    q = s * p + c * q;
    p = turned;
}

// Eigenvalues, and eigenvectors as columns, of the symmetric matrix with the diagonal (xx, yy, zz) and the
// off-diagonal elements (yz, xz, xy). Three sweeps bring the off-diagonal elements below single precision; the fourth
// is a reserve.
vec3 eigen(vec3 diagonal, vec3 off, out mat3 vectors) {
    vec3 x = vec3(1.0, 0.0, 0.0);
    vec3 y = vec3(0.0, 1.0, 0.0);
    vec3 z = vec3(0.0, 0.0, 1.0);
    for (int sweep = 0; sweep < 4; ++sweep) {
        turn(diagonal.x, diagonal.y, off.z, off.y, off.x, x, y);
        turn(diagonal.x, diagonal.z, off.y, off.z, off.x, x, z);
        turn(diagonal.y, diagonal.z, off.x, off.z, off.y, y, z);
    }
    vectors = mat3(x, y, z);
    return diagonal;
}
