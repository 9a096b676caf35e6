// pplane shader 1: colours around the plane's point, by the angle: 6·(1 + cos(2θ + φ)).
fn pplane_1_angle(at: PlanePoint) -> vec3f {
    let v = pplane_from_point(at);
    return 6.0 * color_wheel(v.x, v.y);
}
