// Where a ray hit, and what a surface is like there. Referee: `locate` in src/cpu/trace.rs.

//#if lit

// The primary ray as one from anywhere.
fn as_secondary_ray(ray: Ray) -> SecondaryRay {
//#if certified
    return SecondaryRay(vec3f(0.0), unit_direction(ray), 0.0, DIR_ERROR, 0.0, 0.0);
//#else
    return SecondaryRay(vec3f(0.0), ray.w * ray.inverse_length);
//#end
}
//#end

// Where a primary ray hit.
fn locate(ray: Ray, hit: Hit) -> Point {
    var point: Point;
    point.object = hit.object;
//#if tables
    point.pixel = ray.pixel;
    point.direct = true;
//#end
//#if position
    let s = 1.0 / hit.inverse;
//#if lit
    point.position = barrier(ray.w * s);
//#else
    point.position = ray.w * s;
//#end
//#if certified
    let length = ray.w2 * ray.inverse_length;
    point.error = SECOND_ORDER * s * (W_ERROR + length * (s * hit.error + HIT_ROUNDINGS * U));
    point.size = abs(point.position.x) + abs(point.position.y) + abs(point.position.z);
//#end
//#end
//#if lit
    complete(&point);
//#if lit_quadric
    if (objects[hit.object].place & QUADRIC_BIT) != 0u {
        let t = ray.w2 * ray.inverse_length * s;
        let quadric = quadrics[objects[hit.object].place & ~QUADRIC_BIT];
//#if certified
        let error = t * (SECOND_ORDER * hit.error * s + LENGTH_ERROR);
        on_quadric(&point, quadric_normal(quadric, as_secondary_ray(ray), t, error));
//#else
        on_quadric(&point, quadric_normal(quadric, as_secondary_ray(ray), t));
//#end
    }
//#end
//#if sphere_point
    if (objects[hit.object].place & SPHERE_BIT) != 0u {
        on_sphere(&point, sphere_normal(hit.index, ray, hit));
    }
//#end
//#if bvh
//#if lit_sphere
    if (objects[hit.object].place & SPHERE_BIT) != 0u {
        on_sphere(&point,
            sphere_normal_from(world_spheres[objects[hit.object].place & ~SPHERE_BIT], as_secondary_ray(ray)));
    }
//#end
//#end
//#else
//#if sphere_point
    if (objects[hit.object].kind & 128u) != 0u {
        let normal = sphere_normal(hit.index, ray, hit);
        point.from_center = normal.xyz;
        point.from_center_error = normal.w; //~
    }
//#end
//#end
    return point;
}
//#if lit

const SPHERE_BIT = 0x80000000u;
const QUADRIC_BIT = 0x40000000u;

// Fills in what follows from the object alone, on a plane.
fn complete(point: ptr<function, Point>) {
    let object = objects[(*point).object];
    (*point).group = object.group;
//#if world_planes
    if object.place < QUADRIC_BIT {
        let plane = world_planes[object.place];
        (*point).normal = plane.normal;
        (*point).normal_error = PLANE_NORMAL_ROUNDINGS * U; //~
        (*point).position = (*point).position * plane.axis_mask + plane.fixed_coordinate;
//#if low_light
        (*point).low_light = plane.low_light; //~
        (*point).height = plane.height; //~
//#end
//#if lights_on_surface
        (*point).lights_on_surface = plane.lights_on_surface;
//#end
    }
//#end
}
//#if lit_quadric

// Takes the normal of a quadric, with the bound of its error.
fn on_quadric(point: ptr<function, Point>, normal: vec4f) {
    (*point).normal = normal.xyz;
    (*point).normal_error = normal.w; //~
}
//#end
//#if lit_sphere

// Takes the normal of a sphere, with the bound of its error.
fn on_sphere(point: ptr<function, Point>, normal: vec4f) {
    (*point).from_center = normal.xyz;
    (*point).normal = normal.xyz;
//#if certified
    (*point).from_center_error = normal.w;
    (*point).normal_error = normal.w;
//#else
    (*point).normal /= length3(normal.xyz);
//#end
}
//#end

// Where a ray from anywhere hit.
fn locate_secondary(ray: SecondaryRay, hit: SecondaryHit) -> Point {
    var point: Point;
    point.object = hit.object;
    point.position = barrier(ray.base + hit.t * ray.dir);
//#if certified
    // On a plane: what the line is off by moves the hit within the plane, by no more than `hit.error`.
    point.error = hit.error + POSITION_ROUNDINGS * U * (ray.size + hit.t);
//#end
    complete(&point);
//#if lit_quadric
    if (objects[hit.object].place & QUADRIC_BIT) != 0u {
        let quadric = quadrics[objects[hit.object].place & ~QUADRIC_BIT];
//#if certified
        on_quadric(&point, quadric_normal(quadric, ray, hit.t, hit.error));
        point.error = SECOND_ORDER * (hit.error + ray.base_error + hit.t * ray.dir_error)
            + POSITION_ROUNDINGS * U * (ray.size + hit.t);
//#else
        on_quadric(&point, quadric_normal(quadric, ray, hit.t));
//#end
    }
//#end
//#if sphere_beyond
    let object = objects[hit.object];
    if (object.place & SPHERE_BIT) != 0u {
        let sphere = world_spheres[object.place & ~SPHERE_BIT];
        let normal = sphere_normal_from(sphere, ray);
        on_sphere(&point, normal);
        point.position = barrier(sphere.center + sphere.radius * normal.xyz);
        point.error = SECOND_ORDER * sphere.radius * normal.w //~
            + POSITION_ROUNDINGS * U * (sphere.size + sphere.radius); //~
    }
//#end
//#if certified
    point.size = abs(point.position.x) + abs(point.position.y) + abs(point.position.z);
//#end
    return point;
}
//#end
