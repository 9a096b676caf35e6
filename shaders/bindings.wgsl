// What the host hands over: a dispatch's record, the scene's buffers, and one for the pixels.

// The rectangle of pixels that this dispatch makes.
struct Dispatch {
//#insert members Dispatch
//#if moving
    // The camera, while it moves: the text stays the same then, and is compiled once.
//#insert members CameraNumbers camera_
//#end
}
//#if partial

// Behind the dispatch's pixels comes a list without order of those of which only some samples are sure: records of
// PARTIAL_WORDS words, of place, the sum of such samples, its error, the bits of the samples in it. The list is in one
// buffer with the pixels, since a driver may allow no more buffers than a scene needs anyway.
struct Pixels {
    // Records, those for which there was no room too.
    partials: atomic<u32>,
    words: array<u32>,
}
//#end

//#insert bindings
