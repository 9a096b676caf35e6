// The closest hit of a primary ray. Twin of its loop over objects on the CPU: src/certify/lanes/primary.rs. Referee:
// src/cpu/trace.rs.

// An object as a primary ray meets it.
struct PrimaryIntersection {
    // 1/s, where it is hit: the larger, the nearer; 0 or less is a miss.
    inverse: f32,
    // For sure, where pixels are certified.
    hit: bool,
//#if certified
    error: f32,
    // Whether it may be hit.
    possible: bool,
//#end
}

struct Hit {
    // 1/s: the larger, the nearer; 0 is no hit.
    inverse: f32,
    object: u32,
//#if sphere_point
    // Number among the spheres or planes.
    index: u32,
//#end
//#if certified
    error: f32,
    // Of everything else that may be hit, the largest that 1/s may be.
    rival: f32,
//#if groups
    // Its surface, if others share it: of these the first in the file is hit first, and the others do not count.
    group: u32,
//#end
//#end
//#if screen_grid
    // Whether every object was asked.
    decided: bool,
//#end
}

// Takes a hit if it is nearer, or as near and first in the file.
fn nearer(closest: ptr<function, Hit>, intersection: PrimaryIntersection, object: u32, index: u32, group: u32) {
//#if certified
    var hit = intersection.hit;
    var possible = intersection.possible;
//#if groups
    let fresh = (group == 0u) | (group != (*closest).group);
    hit &= fresh;
    possible &= fresh;
//#end
    let takes = hit & (intersection.inverse > (*closest).inverse);
    let high = select(0.0, intersection.inverse + intersection.error, possible);
    (*closest).rival = max((*closest).rival, select(high, (*closest).inverse + (*closest).error, takes));
    (*closest).error = select((*closest).error, intersection.error, takes);
//#if groups
    (*closest).group = select((*closest).group, group, takes);
//#end
//#else
//#if mixed
    let best = *closest;
    let takes = intersection.hit & (intersection.inverse > 0.0)
        & ((intersection.inverse > best.inverse) | ((intersection.inverse == best.inverse) & (object < best.object)));
//#else
    // Objects of one kind come in the order of the file.
    let takes = intersection.hit & (intersection.inverse > (*closest).inverse);
//#end
//#end
    (*closest).inverse = select((*closest).inverse, intersection.inverse, takes);
    (*closest).object = select((*closest).object, object, takes);
//#if sphere_point
    (*closest).index = select((*closest).index, index, takes);
//#end
}

// The closest object that the ray hits.
fn find_closest_object(ray: Ray) -> Hit {
    var closest: Hit;
//#insert unrolled
//#if polygon_loop
    for (var i = 0u; i < POLYGONS; i += 1u) {
        nearer(&closest, polygon_hits(polygons[i], ray), polygons[i].object, i, polygons[i].group);
    }
//#end
//#if plane_loop
    for (var i = 0u; i < PLANES; i += 1u) {
        nearer(&closest, plane_hits(planes[i], ray), planes[i].object, i, planes[i].group);
    }
//#end
//#if quadric_loop
    for (var i = 0u; i < QUADRICS; i += 1u) {
        nearer(&closest, quadric_hits(quadrics[i], ray), quadrics[i].object, i, 0u);
    }
//#end
//#if sphere_loop
    for (var i = 0u; i < SPHERES; i += 1u) {
        let sphere = sphere_at(i);
        nearer(&closest, sphere_hits(sphere, ray), sphere.object, i, 0u);
    }
//#end
//#if screen_grid
    // Those that may be seen in this cell of the screen, the nearest first: once one is hit, those farther off do not
    // count.
    let cell = u32(ray.pixel.y) / CELL_HEIGHT * GRID_COLUMNS + u32(ray.pixel.x) / CELL_WIDTH;
    let first = screen_grid[cell];
    let end = screen_grid[cell + 1u];
    let last = min(end, first + (STEPS_LIMIT - min(steps, STEPS_LIMIT)) / LANES);
    closest.decided = last == end;
    var place = first;
    for (; place < last; place += 1u) {
        let index = screen_grid[place];
//#if certified
        let least = closest.inverse - closest.error;
//#else
        let least = closest.inverse;
//#end
//#if grid_triangles
        if index >= GRID_SPHERES {
            let polygon = polygons[LOOSE_POLYGONS + index - GRID_SPHERES];
            if polygon.max_inverse < least {
                closest.decided = true;
                break;
            }
            // Triangles of a cell are not in the order of the file, so that none stands for others on its plane.
            nearer(&closest, polygon_hits(polygon, ray), polygon.object, index, 0u);
            continue;
        }
//#end
//#if grid_spheres
        let sphere = sphere_at(index);
        if sphere.max_inverse < least {
            closest.decided = true;
            break;
        }
        nearer(&closest, sphere_hits(sphere, ray), sphere.object, index, 0u);
//#end
    }
    steps += LANES * (place - first + 1u);
//#end
    return closest;
}
