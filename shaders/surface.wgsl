// The reflectivity of an object at a hit. Twin: src/cpu/surface.rs.

struct Object {
    // The material's ambient reflectivity.
    ambient: vec3f,
    // What modulates it: KIND_… in the low byte, the index of its record above.
    kind: u32,
}
//#if odd

// 1 where the integers are odd, 0 where they are even.
fn odd3(index: vec3f) -> vec3f {
    return index - 2.0 * floor(index * 0.5);
}
//#end
//#if tiled

struct Tiled {
    // Tile indices along x and z: floor(P·per_unit + fraction), up to `parity`.
    per_unit: vec2f,
    fraction: vec2f,
    altmaterial: vec3f,
    // The two host-side parities together: 0, 1 or 2.
    parity: f32,
}

// Whether a tile is of the plane's own material.
fn tplane_foreground(plane: Tiled, position: vec3f) -> bool {
    let index = floor(position.xz * plane.per_unit + plane.fraction);
    let odd = odd3(vec3f(index, 0.0));
    return odd3(vec3f(odd.x + odd.y + plane.parity)).x == 0.0;
}
//#end
//#if pplane

struct Pplane {
    // The indices floor(2·H + 1000): floor(P·per_unit + fraction), up to `parity` (0 or 1 each).
    per_unit: vec3f,
    unused_0: u32,
    fraction: vec3f,
    unused_1: u32,
    parity: vec3f,
    unused_2: u32,
    // The components x and y of H − point: P·from_point.xy − from_point.zw.
    from_point: vec4f,
}

// What a procedural plane's shader is told about the hit.
struct PlanePoint {
    position: vec3f,
    ambient: vec3f,
    plane: Pplane,
}
//#end
//#if pplane_odd

// Parities of floor(2·H + 1000), each 0 or 1.
fn pplane_odd(at: PlanePoint) -> vec3f {
    return odd3(floor(at.position * at.plane.per_unit + at.plane.fraction) + at.plane.parity);
}
//#end
//#if pplane_from_point

// Components x and y of H − point.
fn pplane_from_point(at: PlanePoint) -> vec2f {
    return at.position.xy * at.plane.from_point.xy - at.plane.from_point.zw;
}
//#end
//#if psphere

// What a procedural sphere's shader is told about the hit.
struct SpherePoint {
    from_center: vec3f,
    ambient: vec3f,
}
//#end
//#if color_wheel

// (1 + cos 2θ, 1 + cos(2θ + 2π/3), 1 + cos(2θ + 4π/3)), θ the angle of (x, y) from +x; θ = 0 at the origin.
// By 1 + cos 2α = 2·cos²α: no acos, no cos, and nothing cancels.
fn color_wheel(x: f32, y: f32) -> vec3f {
    let larger = max(abs(x), abs(y));
    if !(larger > 0.0) {
        return vec3f(2.0, 0.5, 0.5);
    }
    let v = vec2f(x, y) / larger;
    let cosines = vec3f(v.x, 0.5 * v.x - HALF_ROOT_3 * v.y, 0.5 * v.x + HALF_ROOT_3 * v.y);
    return cosines * cosines * (2.0 / dot(v, v));
}

const HALF_ROOT_3 = 0.86602540378443864676f;
//#end
//#insert procedural

// The ambient reflectivity at a hit.
fn getamb(ray: Ray, hit: Hit) -> vec3f {
    let object = objects[hit.object];
//#if modulated
    let record = object.kind >> 8u;
    switch object.kind & 255u {
//#if tiled
        case KIND_TILED: {
            let plane = tiled_planes[record];
            return select(plane.altmaterial, object.ambient, tplane_foreground(plane, ray.w / hit.inverse));
        }
//#end
//#insert procedural_cases
        default: {}
    }
//#end
    return object.ambient;
}
