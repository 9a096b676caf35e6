//! Two pictures of the same size: how many pixels differ, by how much, and where the worst is.
//!
//! The end of the way back from files, after `read`; what `plumb compare` and the tests go by.

use std::fmt;

use serde::Serialize;

use super::Picture;

/// Red, green or blue.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Channel {
    /// The first byte of a pixel.
    Red,
    /// The second.
    Green,
    /// The third.
    Blue,
}

impl Channel {
    /// All, in the order of the bytes of a pixel.
    pub const ALL: [Self; 3] = [Self::Red, Self::Green, Self::Blue];
}

impl fmt::Display for Channel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Red => "red",
            Self::Green => "green",
            Self::Blue => "blue",
        })
    }
}

/// How two pictures differ.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Comparison {
    /// Columns of both.
    pub width: u32,
    /// Rows of both.
    pub height: u32,
    /// Pixels of each.
    pub pixels: u64,
    /// Pixels that differ in some channel.
    pub different: u64,
    /// The same in percent of all pixels: 0 to 100.
    pub percent: f64,
    /// Pixels that differ in red, green, blue.
    pub channels: [u64; 3],
    /// The largest difference of a channel; none if the pictures are the same. Of several the topmost, of these the
    /// leftmost, of these the first channel.
    pub worst: Option<Worst>,
    /// Root of the mean of the squared differences of all channels of all pixels, in bytes: 0 to 255.
    pub rms: f64,
}

impl Comparison {
    /// Whether the pictures are the same, byte for byte.
    #[must_use]
    pub fn is_same(&self) -> bool {
        self.different == 0
    }
}

/// The largest difference of a channel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Worst {
    /// The pixel's column, from the left.
    pub x: u32,
    /// The pixel's row, from the bottom.
    pub y: u32,
    /// The channel.
    pub channel: Channel,
    /// The byte in the first picture.
    pub a: u8,
    /// The byte in the second.
    pub b: u8,
    /// How far they are apart: 1 to 255.
    pub difference: u8,
}

/// Pictures of different sizes cannot be compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("the pictures have different sizes: {} × {} and {} × {} pixels", .a.0, .a.1, .b.0, .b.1)]
pub struct SizesDiffer {
    /// Width and height of the first.
    pub a: (u32, u32),
    /// Width and height of the second.
    pub b: (u32, u32),
}

/// The pixels of both, side by side, if the sizes allow it.
fn pairs<'a>(
    a: &'a Picture,
    b: &'a Picture,
) -> Result<impl Iterator<Item = (&'a [u8; 3], &'a [u8; 3])>, SizesDiffer> {
    let sizes = |picture: &Picture| (picture.width, picture.height, picture.rgb.len());
    if sizes(a) != sizes(b) {
        return Err(SizesDiffer {
            a: (a.width, a.height),
            b: (b.width, b.height),
        });
    }
    Ok(a.rgb.as_chunks().0.iter().zip(b.rgb.as_chunks().0))
}

/// Compares two pictures.
///
/// # Errors
/// [`SizesDiffer`] if they do not have the same width and height.
pub fn compare(a: &Picture, b: &Picture) -> Result<Comparison, SizesDiffer> {
    let mut different = 0;
    let mut channels = [0; 3];
    // The sum of all squares fits: 255² · 3 · 2⁶⁴ would not, but no memory holds that many pixels.
    let mut squares: u64 = 0;
    let mut worst: Option<(usize, usize, u8)> = None;
    for (index, (p, q)) in pairs(a, b)?.enumerate() {
        if p == q {
            continue;
        }
        different += 1;
        for channel in 0..3 {
            let difference = p[channel].abs_diff(q[channel]);
            if difference == 0 {
                continue;
            }
            channels[channel] += 1;
            squares += u64::from(difference).pow(2);
            if worst.is_none_or(|(_, _, most)| difference > most) {
                worst = Some((index, channel, difference));
            }
        }
    }
    let pixels = u64::from(a.width) * u64::from(a.height);
    // A picture without pixels differs in none of them.
    let all = pixels.max(1) as f64;
    let width = a.width as usize;
    let worst = worst.map(|(index, channel, difference)| Worst {
        x: (index % width) as u32,
        y: a.height - 1 - (index / width) as u32,
        channel: Channel::ALL[channel],
        a: a.rgb[3 * index + channel],
        b: b.rgb[3 * index + channel],
        difference,
    });
    Ok(Comparison {
        width: a.width,
        height: a.height,
        pixels,
        different,
        percent: 100.0 * different as f64 / all,
        channels,
        worst,
        rms: (squares as f64 / (3.0 * all)).sqrt(),
    })
}

/// A picture of where two pictures differ.
///
/// Pixels that are the same are grey and dark, at most 63: a quarter of the first picture's mean of the three
/// channels, so that one still sees what is where. Pixels that differ are black but for the channels that differ, which
/// are 127 + half the difference, rounded up: 128 for one, 255 for 255, brighter than anything that is the same.
///
/// # Errors
/// [`SizesDiffer`] if they do not have the same width and height.
pub fn difference(a: &Picture, b: &Picture) -> Result<Picture, SizesDiffer> {
    let mut rgb = Vec::with_capacity(a.rgb.len());
    for (p, q) in pairs(a, b)? {
        if p == q {
            let sum: u16 = p.iter().copied().map(u16::from).sum();
            rgb.extend([(sum / 12) as u8; 3]);
        } else {
            rgb.extend(
                [0, 1, 2].map(|channel| match p[channel].abs_diff(q[channel]) {
                    0 => 0,
                    difference => 127 + difference.div_ceil(2),
                }),
            );
        }
    }
    Ok(Picture {
        width: a.width,
        height: a.height,
        rgb,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(width: u32, height: u32) -> Picture {
        let rgb = (0..3 * width * height)
            .map(|n| (n * 7 % 256) as u8)
            .collect();
        Picture { width, height, rgb }
    }

    #[test]
    fn a_picture_is_the_same_as_itself() {
        let a = picture(31, 17);
        let same = compare(&a, &a).unwrap();
        assert!(same.is_same());
        assert_eq!(
            (same.different, same.worst, same.channels),
            (0, None, [0; 3])
        );
        assert_eq!((same.percent, same.rms), (0.0, 0.0));
        assert!(
            difference(&a, &a)
                .unwrap()
                .rgb
                .iter()
                .all(|&byte| byte < 64)
        );
    }

    /// The comparator is what all other tests go by: it must find one step in one channel of one pixel, wherever.
    #[test]
    fn a_difference_of_one_is_found_wherever_it_is() {
        let (width, height) = (5, 4);
        let a = picture(width, height);
        for at in 0..a.rgb.len() {
            for step in [1i16, -1] {
                let mut b = a.clone();
                let Ok(stepped) = u8::try_from(i16::from(b.rgb[at]) + step) else {
                    continue;
                };
                b.rgb[at] = stepped;
                let found = compare(&a, &b).unwrap();
                assert_eq!(found.different, 1);
                assert_eq!(found.pixels, 20);
                assert_eq!(found.percent, 5.0);
                let (pixel, channel) = (at as u32 / 3, at % 3);
                let mut channels = [0; 3];
                channels[channel] = 1;
                assert_eq!(found.channels, channels);
                let worst = Worst {
                    x: pixel % width,
                    y: height - 1 - pixel / width,
                    channel: Channel::ALL[channel],
                    a: a.rgb[at],
                    b: stepped,
                    difference: 1,
                };
                assert_eq!(found.worst, Some(worst));
                assert_eq!(found.rms, (1.0f64 / 60.0).sqrt());
                let seen = difference(&a, &b).unwrap();
                for (index, &byte) in seen.rgb.iter().enumerate() {
                    match index {
                        _ if index == at => assert_eq!(byte, 128),
                        _ if index / 3 == at / 3 => assert_eq!(byte, 0),
                        _ => assert!(byte < 64),
                    }
                }
            }
        }
    }

    #[test]
    fn the_worst_of_several_is_told_and_the_first_of_equals() {
        let a = Picture {
            width: 3,
            height: 3,
            rgb: vec![0; 27],
        };
        let mut b = a.clone();
        b.rgb[2] = 9; // (0, 2) blue
        b.rgb[10] = 255; // (0, 1) green
        b.rgb[26] = 255; // (2, 0) blue
        b.rgb[24] = 1; // (2, 0) red
        let found = compare(&a, &b).unwrap();
        let worst = found.worst.unwrap();
        assert_eq!(
            (worst.x, worst.y, worst.channel, worst.difference),
            (0, 1, Channel::Green, 255)
        );
        assert_eq!((found.different, found.channels), (3, [1, 1, 2]));
        assert_eq!(found.rms, (f64::from(81 + 2 * 65025 + 1) / 27.0).sqrt());
        assert_eq!(compare(&b, &a).unwrap().different, 3);
        assert_eq!(difference(&a, &b).unwrap().rgb[24..], [128, 0, 255]);
    }

    #[test]
    fn different_sizes_are_refused() {
        let differ = compare(&picture(2, 3), &picture(3, 2)).unwrap_err();
        assert_eq!(
            differ.to_string(),
            "the pictures have different sizes: 2 × 3 and 3 × 2 pixels"
        );
        assert!(difference(&picture(2, 3), &picture(2, 4)).is_err());
    }
}
