// Draws a picture from its buffer: each pixel of the window takes a word, and shows its bytes as they are; where the
// picture is made smaller, the mean of those that it covers.

struct ScreenUniforms {
    // Where the picture's top left corner is, in pixels of the window.
    origin: vec2i,
    // Columns and rows that the picture is drawn as; of the buffer; of the buffer of objects.
    size: vec2u,
    canvas: vec2u,
    marked: vec2u,
    // Pixels of the window for each of the picture, and the same as a whole number; 0 where it is none.
    zoom: f32,
    times: u32,
    // Whether to paint what decided each pixel.
    verdicts: u32,
    nothing: u32,
}

@group(0) @binding(0) var<uniform> view: ScreenUniforms;
// Red, green, blue from the lowest byte up, and what decided them.
@group(0) @binding(1) var<storage, read> pixels: array<u32>;
// What each pixel sees: the number of an object, from 1; 0 is nothing.
@group(0) @binding(2) var<storage, read> objects: array<u32>;
// A bit for each of these numbers, from the lowest up: whether the object is to be outlined.
@group(0) @binding(3) var<storage, read> chosen: array<u32>;

@vertex
fn corner(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
    // A triangle larger than what is drawn into.
    return vec4f(vec2f(f32(i & 1u), f32(i >> 1u)) * 4.0 - 1.0, 0.0, 1.0);
}

// The pixel of the picture at a pixel of the window; outside where it is not below `view.size`.
fn pixel_at(at: vec2i) -> vec2u {
    let offset = at - view.origin;
    if any(offset < vec2i(0)) {
        return vec2u(0xffffffffu);
    }
    if view.times > 0u {
        return vec2u(offset) / view.times;
    }
    return vec2u((vec2f(offset) + 0.5) / view.zoom);
}

// The place of a pixel in a buffer that may have fewer.
fn place(pixel: vec2u, size: vec2u) -> u32 {
    var at = pixel;
    if any(size != view.size) {
        at = min(vec2u((vec2f(pixel) + 0.5) * vec2f(size) / vec2f(view.size)), size - 1u);
    }
    return at.y * size.x + at.x;
}

fn is_chosen(at: vec2i) -> bool {
    let pixel = pixel_at(at);
    if any(pixel >= view.size) {
        return false;
    }
    let object = objects[place(pixel, view.marked)];
    return (chosen[object / 32u] >> (object % 32u) & 1u) != 0u;
}

// The bytes of a pixel, or the colour of what decided it.
fn shown(pixel: vec2u) -> vec3f {
    let word = pixels[place(pixel, view.canvas)];
    let bytes = vec3f(vec3u(word, word >> 8u, word >> 16u) & vec3u(255u));
    if view.verdicts != 0u {
        return verdict(word >> 24u, bytes);
    }
    return bytes;
}

// The mean over the area of the picture that a pixel of the window covers, where that is more than one of its pixels.
// It is the mean of the bytes as they are: they are proportional to the light in the language, without gamma, and
// several samples are averaged in them too, so a picture at 50 % looks like one of half the size with more samples.
fn mean(at: vec2i) -> vec3f {
    let first = vec2f(at - view.origin) / view.zoom;
    let last = min(first + 1.0 / view.zoom, vec2f(view.size));
    let start = floor(first);
    let stride = max(vec2f(1.0), ceil((ceil(last) - start) / TAPS));
    var sum = vec3f(0.0);
    var area = 0.0;
    for (var y = start.y; y < last.y; y += stride.y) {
        let height = min(last.y, y + stride.y) - max(first.y, y);
        for (var x = start.x; x < last.x; x += stride.x) {
            let weight = height * (min(last.x, x + stride.x) - max(first.x, x));
            let pixel = min(vec2u(vec2f(x, y) + floor(0.5 * stride)), view.size - 1u);
            sum += weight * shown(pixel);
            area += weight;
        }
    }
    return sum / area;
}

@fragment
fn color(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let at = vec2i(position.xy);
    // No other pixels of the window are drawn than those that the picture covers, the last of them perhaps by less than
    // half.
    let pixel = min(pixel_at(at), view.size - 1u);
    var bytes: vec3f;
    if view.zoom < 1.0 {
        bytes = mean(at);
    } else {
        bytes = shown(pixel);
    }
    if view.marked.x > 0u {
        let inside = is_chosen(at);
        let across = vec2i(BORDER, 0);
        let down = vec2i(0, BORDER);
        let border = inside != is_chosen(at + across) | inside != is_chosen(at - across)
            | inside != is_chosen(at + down) | inside != is_chosen(at - down);
        bytes = select(bytes, OUTLINE, border);
    }
    return vec4f(bytes / 255.0, 1.0);
}
