// pplane shader 0: tiles of half a unit; the ambient colour without red (i + j odd), or without blue.
fn pplane_0_tiles(at: PlanePoint) -> Shade {
    var shade: Shade;
    let odd = pplane_odd(at, vec3f(1.0, 0.0, 1.0));
    shade.color = at.ambient * select(vec3f(1.0, 1.0, 0.0), vec3f(0.0, 1.0, 1.0), odd.x != odd.z);
    return shade;
}
