// psphere shader 0: colours around the sphere's axis, by the angle of (c.x, −|c.y|).
fn psphere_0_angle(at: SpherePoint) -> Shade {
    return color_wheel(at.from_center.x, -abs(at.from_center.y), at.error);
}
