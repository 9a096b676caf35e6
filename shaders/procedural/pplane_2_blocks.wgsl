// pplane shader 2: blocks of half a unit, by turns shader 1's colours (i + j + k even) and the material's ambient.
fn pplane_2_blocks(at: PlanePoint) -> Shade {
    let odd = pplane_odd(at, vec3f(1.0));
    if odd.x + odd.y + odd.z == 0.0 || odd.x + odd.y + odd.z == 2.0 {
        return pplane_1_angle(at);
    }
    var shade: Shade;
    shade.color = at.ambient;
    return shade;
}
