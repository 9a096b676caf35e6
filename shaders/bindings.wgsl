// What the host hands over. Struct offsets are those of src/gpu/pack/records.rs; a test compares them.

// The rectangle of pixels that this dispatch makes: column and row of its top left pixel, columns and rows.
struct Job {
    first: vec2u,
    size: vec2u,
    // 0, for `barrier`.
    zero: u32,
//#if partial
    // Records that there is room for behind the pixels.
    room: u32,
//#else
    unused: u32,
//#end
//#if moving
    // The camera, while it moves: the text stays the same then, and is compiled once.
    camera_anchor: vec2i,
    camera_step: vec2f,
    camera_offset: vec2f,
    camera_distance: f32,
    camera_gain: f32,
    unit: f32,
    camera_unused: u32,
//#end
}

@group(0) @binding(0) var<uniform> job: Job;
//#if values
// Red, green, blue as f32 (255 is a full byte), then the packed bytes as below.
@group(0) @binding(1) var<storage, read_write> pixels: array<vec4u>;
//#else
// Red, green, blue from the lowest byte up, and in the highest UNDECIDED where the CPU has to decide, else 0.
//#if quad
// Four pixels side by side; rows are filled up.
@group(0) @binding(1) var<storage, read_write> pixels: array<vec4u>;
//#else
//#if partial
// Behind the dispatch's pixels comes a list without order of those of which only some samples are sure: records of
// PARTIAL_WORDS words, of place, the sum of such samples, its error, the bits of the samples in it. In one buffer with the
// pixels, since a driver may allow no more than a scene needs anyway.
struct Pixels {
    // Records, those for which there was no room too.
    partials: atomic<u32>,
    words: array<u32>,
}
@group(0) @binding(1) var<storage, read_write> pixels: Pixels;
//#else
@group(0) @binding(1) var<storage, read_write> pixels: array<u32>;
//#end
//#end
//#end
//#if any_object
// One for each object of the scene, in file order; after them, if there are any, come the tables that `told` reads.
@group(0) @binding(2) var<storage, read> objects: array<Object>;
//#end
//#if plane_loop
@group(0) @binding(3) var<storage, read> planes: array<Plane>;
//#end
//#if rectangle_loop
@group(0) @binding(4) var<storage, read> rectangles: array<Rectangle>;
//#end
//#if sphere_buffer
//#if sphere_point
@group(0) @binding(5) var<storage, read> spheres: array<SphereAndHit>;
//#else
@group(0) @binding(5) var<storage, read> spheres: array<Sphere>;
//#end
//#end
//#if tiles
// Where the list of each tile of the screen starts here, by rows from the bottom left, and where the last one ends; then the
// lists: indices into `spheres`, the nearest first.
@group(0) @binding(6) var<storage, read> tiles: array<u32>;
//#end
//#if bvh
@group(0) @binding(7) var<storage, read> bvh: array<BvhNode>;
//#end
//#if tiled
@group(0) @binding(8) var<storage, read> tiled_planes: array<Tiled>;
//#end
//#if pplane
@group(0) @binding(9) var<storage, read> pplanes: array<Pplane>;
//#end
//#if textured
@group(0) @binding(10) var<storage, read> texplanes: array<Texplane>;
// Red, green, blue from the lowest byte up; all textures one after the other, bottom rows first.
@group(0) @binding(11) var<storage, read> texels: array<u32>;
//#end
//#if lit
@group(0) @binding(12) var<storage, read> materials: array<Material>;
@group(0) @binding(13) var<storage, read> lights: array<Light>;
// Where the objects are for rays from anywhere; each object of the scene knows its place in one of these.
//#end
//#if world_planes
@group(0) @binding(14) var<storage, read> world_planes: array<WorldPlane>;
//#end
//#if world_spheres
@group(0) @binding(15) var<storage, read> world_spheres: array<WorldSphere>;
//#end
//#if course
// The offsets of the samples in their pixels: those of a pixel together, pixels as in `pixels`.
@group(0) @binding(16) var<storage, read> offsets: array<vec2f>;
//#end
