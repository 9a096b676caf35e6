//! Every number of every record is checked as its field says.

use super::*;
use crate::shader::bounds::{LARGEST, SMALLEST};
use crate::shader::record::{FieldLayout, Layout};

/// How many f32 stand in a field, those of a record within it not counted: that is tested by itself.
fn floats(field: &FieldLayout) -> usize {
    match field.wgsl {
        "f32" => 1,
        "vec2f" => 2,
        "vec3f" => 3,
        "vec4f" => 4,
        _ => 0,
    }
}

/// Whether the record fits that is 0 but for one number.
fn fits_with(layout: &Layout, offset: usize, value: f32) -> bool {
    let mut bytes = vec![0; layout.size];
    bytes[offset..offset + 4].copy_from_slice(&value.to_le_bytes());
    (layout.fits)(&bytes)
}

/// A factor that f32 might flush is noticed, and nothing else need not be tiny.
#[test]
fn a_tiny_factor_is_noticed() {
    let smallest = SMALLEST as f32;
    let mut factors = 0;
    for layout in layouts() {
        for field in layout.fields {
            for offset in (0..floats(field)).map(|i| field.offset + 4 * i) {
                assert!(fits_with(layout, offset, smallest));
                for value in [smallest.next_down(), f32::MIN_POSITIVE, 1e-45] {
                    let fits = fits_with(layout, offset, value);
                    assert_eq!(
                        fits,
                        field.factor.is_none(),
                        "{}.{}",
                        layout.name,
                        field.name
                    );
                }
                factors += usize::from(field.factor.is_some());
            }
        }
    }
    assert!(factors > 20, "{factors}");
}

/// What a field holds is checked unless the field says why it need not be: none can be forgotten.
#[test]
fn a_large_number_in_any_field_is_noticed() {
    let largest = LARGEST as f32;
    let (mut checked, mut free) = (0, 0);
    for layout in layouts() {
        for field in layout.fields {
            for offset in (0..floats(field)).map(|i| field.offset + 4 * i) {
                assert!(fits_with(layout, offset, largest));
                for value in [largest.next_up(), -f32::MAX, f32::INFINITY, f32::NAN] {
                    let fits = fits_with(layout, offset, value);
                    assert_eq!(
                        fits,
                        field.any_size.is_some(),
                        "{}.{}",
                        layout.name,
                        field.name
                    );
                }
                checked += 1;
                free += usize::from(field.any_size.is_some());
            }
        }
    }
    assert!(checked > 150 && free < 20, "{checked} {free}");
}
