// What a light brings to a hit point. Twin: src/cpu/light.rs.

struct Light {
    // From the viewpoint.
    location: vec3f,
    // Cosine of a spotlight's half angle; below −1 for any other light.
    cosine: f32,
    emissivity: vec3f,
    unused_0: u32,
    // A spotlight's axis.
    axis: vec3f,
    unused_1: u32,
}

// The share of light number `number` that reaches the point along `d`.
fn shadow(point: Point, d: vec3f, distance: f32, number: u32) -> vec3f {
    let bit = select(0u, 1u << number, number < 32u);
//#if clear
    var filter_ = vec3f(1.0);
    var range = Range(point.group, bit, 0.0, distance);
    loop {
        let met = closest_from(point.position, d, range, LANES);
        steps += 2u * LANES;
        if met.object == NOTHING || steps > STEPS_LIMIT {
            return filter_;
        }
        let blocker = locate_met(point.position, d, met);
        let material = materials[objects[met.object].material];
        if material.transparency == 0.0 {
            return vec3f(0.0);
        }
        filter_ *= materials[tile_material(blocker)].tint * material.transparency;
        range.skip = blocker.group;
        range.beyond = met.t;
    }
    return filter_;
//#else
    return vec3f(select(1.0, 0.0, anything_from(point.position, d, Range(point.group, bit, 0.0, distance))));
//#end
}

// What light number `number` brings to a point with diffuse reflectivity `diffuse`, seen by a ray from `base`.
fn light_term(number: u32, point: Point, base: vec3f, diffuse: vec3f) -> vec3f {
    let light = lights[number];
    let toward = light.location - point.position;
    let distance = length3(toward);
    let d = toward / distance;
    let c = dot(d, point.normal);
//#if level
    let level = number < 32u && (point.level & (1u << number)) != 0u;
    if !(distance > 0.0 && c > 0.0) || level {
//#else
    if !(distance > 0.0 && c > 0.0) {
//#end
        return vec3f(0.0);
    }
//#if cone
    if !(-dot(d, light.axis) > light.cosine) {
        return vec3f(0.0);
    }
//#end
    let filter_ = shadow(point, d, distance, number);
    if !any(filter_ > vec3f(0.0)) {
        return vec3f(0.0);
    }
    var color = diffuse * light.emissivity * filter_ * (c / distance * UNIT);
//#if glint
    let material = materials[objects[point.object].material];
    let back = base - point.position;
    let half = back / length3(back) + d;
    let along = dot(half, point.normal);
    if material.shininess > 0.0 && along > 0.0 {
        color += material.specular * light.emissivity * pow(min(along / length3(half), 1.0), material.shininess);
    }
//#end
    return color;
}
