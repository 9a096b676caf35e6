// pplane shader 1: colours around the plane's point, by the angle: 6·(1 + cos(2θ + φ)).
fn pplane_1_angle(at: PlanePoint) -> Shade {
    let v = pplane_from_point(at);
    var shade = color_wheel(v.x, v.y, v.z);
    shade.color *= 6.0;
    shade.error *= 6.0; //~
    return shade;
}
