//! Every known answer of the notes about vectors, matrices and rays (docs/SCENE.md, "The notes' known answers"), to the
//! digits printed there.

mod pixel_to_ray;

use glam::{DMat3, DVec2, DVec3};
use plumb::cpu::camera::camera_getdir;
use plumb::prepare::Camera;
use plumb::scene;
use plumb::vector::{project, reflect, rotation, rotation_of_axes};

const fn vec(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

/// As the notes' `vec_prn` prints a vector, `%8.3lf` three times.
fn prn(v: DVec3) -> String {
    format!("{:8.3}{:8.3}{:8.3}", v.x, v.y, v.z)
}

/// A matrix by its rows, as the notes write one.
fn rows(r0: DVec3, r1: DVec3, r2: DVec3) -> DMat3 {
    DMat3::from_cols(r0, r1, r2).transpose()
}

fn assert_close(a: DVec3, b: DVec3) {
    assert!((a - b).abs().max_element() < 1e-15, "{a} is not {b}");
}

mod arithmetic {
    use super::*;

    #[test]
    fn directions_between_two_points() {
        let (v, p) = (vec(8.0, 6.0, 5.0), vec(3.0, 2.0, 0.0));
        assert_eq!(p - v, vec(-5.0, -4.0, -5.0));
        assert_eq!(v - p, vec(5.0, 4.0, 5.0));
        assert_eq!(v.distance(p), 66.0_f64.sqrt());
        assert_eq!(format!("{:.2}", (p - v).length()), "8.12");
    }

    #[test]
    fn in_the_plane() {
        let (p, q) = (DVec2::new(5.0, 1.0), DVec2::new(2.0, 4.0));
        let r = p + q;
        assert_eq!(r, DVec2::new(7.0, 5.0));
        assert_eq!(r - q, p);
    }

    #[test]
    fn sum_difference_multiple() {
        let (p, q) = (vec(3.0, 4.0, 5.0), vec(1.0, 2.0, 6.0));
        assert_eq!(p + q, vec(4.0, 6.0, 11.0));
        assert_eq!(p - q, vec(2.0, 2.0, -1.0));
        assert_eq!(3.0 * vec(1.0, 2.0, 3.0), vec(3.0, 6.0, 9.0));
    }

    #[test]
    fn length_and_dot() {
        let p = vec(3.0, 4.0, 5.0);
        assert_eq!(p.length(), 50.0_f64.sqrt());
        assert_eq!(p.length(), p.dot(p).sqrt());
        assert_eq!(vec(2.0, 3.0, 4.0).dot(vec(3.0, 2.0, 1.0)), 16.0);
    }

    #[test]
    fn dot_of_unit_vectors_is_the_cosine() {
        let (u, v) = (vec(1.0, 0.0, 0.0), vec(0.5, 0.75_f64.sqrt(), 0.0));
        assert_eq!(u.dot(v), v.dot(u));
        assert!((u.dot(v).acos().to_degrees() - 60.0).abs() < 1e-12);
    }

    #[test]
    fn the_driver_prints_what_the_notes_show() {
        let v1 = vec(3.0, 4.0, 5.0);
        let v2 = vec(4.0, -1.0, 2.0);
        assert_eq!(prn(v1), "   3.000   4.000   5.000");
        assert_eq!(prn(v2), "   4.000  -1.000   2.000");
        assert_eq!(prn(v2 - v1), "   1.000  -5.000  -3.000");
        assert_eq!(format!("{:8.3}", v1.dot(v2)), "  18.000");
        let length = v1.length();
        assert_eq!(format!("{length:8.3}"), "   7.071");
        assert_eq!(prn(1.0 / length * v1), "   0.424   0.566   0.707");
        assert_eq!(prn(v1.normalize()), "   0.424   0.566   0.707");
    }

    #[test]
    fn cross() {
        let (v, w) = (vec(1.0, 1.0, 1.0), vec(0.0, -1.0, 0.0));
        let perpendicular = v.cross(w);
        assert_eq!(perpendicular, vec(1.0, 0.0, -1.0));
        assert_eq!([perpendicular.dot(v), perpendicular.dot(w)], [0.0, 0.0]);
        assert_eq!(w.cross(v), -perpendicular);
    }

    #[test]
    fn the_axes_are_right_handed() {
        assert_eq!(DVec3::X.cross(DVec3::Y), DVec3::Z);
        assert_eq!(DVec3::Y.cross(DVec3::Z), DVec3::X);
        assert_eq!(DVec3::Z.cross(DVec3::X), DVec3::Y);
        assert_eq!(DVec3::X.cross(DVec3::Z), -DVec3::Y);
    }
}

mod project_and_reflect {
    use super::*;

    #[test]
    fn onto_the_plane_y_0() {
        assert_eq!(project(DVec3::Y, vec(1.0, 1.0, 1.0)), vec(1.0, 0.0, 1.0));
        // The side that the normal points to does not matter.
        assert_eq!(project(-DVec3::Y, vec(1.0, 1.0, 1.0)), vec(1.0, 0.0, 1.0));
    }

    #[test]
    fn what_is_projected_lies_in_the_plane_below() {
        let n = vec(3.0, 4.0, 5.0).normalize();
        let v = vec(4.0, -1.0, 2.0).normalize();
        let p = project(n, v);
        assert!(n.dot(p).abs() < 1e-15);
        // V = Q + P, and Q, the projection on N, has the length of the cosine.
        assert_close(v, n.dot(v) * n + p);
        assert_close(project(n, p), p);
    }

    #[test]
    fn off_a_floor() {
        let down = vec(1.0, -1.0, 0.0).normalize();
        assert_eq!(prn(reflect(down, DVec3::Y)), "   0.707   0.707   0.000");
        assert_eq!(reflect(-DVec3::Y, DVec3::Y), DVec3::Y);
        assert_eq!(reflect(DVec3::X, DVec3::Y), DVec3::X);
    }

    #[test]
    fn angles_of_incidence_and_reflection_are_equal() {
        let n = vec(3.0, 4.0, 5.0).normalize();
        let unitin = vec(-4.0, 1.0, -2.0).normalize();
        let (u, v) = (-unitin, reflect(unitin, n));
        assert!((v.length() - 1.0).abs() < 1e-15);
        assert!((u.dot(n) - v.dot(n)).abs() < 1e-15);
        // U + V = 2N cos T: so V is in the plane of U and N, too.
        assert_close(u + v, 2.0 * n * u.dot(n));
        assert_close(reflect(-v, n), u);
    }
}

mod matrices {
    use super::*;

    #[test]
    fn matrix_times_vector() {
        let m = rows(vec(1.0, 1.0, 0.0), vec(-1.0, 1.0, 0.0), vec(0.0, 0.0, 1.0));
        let v = vec(1.0, 0.0, -2.0);
        assert_eq!(m * v, vec(1.0, -1.0, -2.0));
        // Element i of the product is row i times the vector.
        for i in 0..3 {
            assert_eq!((m * v)[i], m.row(i).dot(v));
        }
        // Rows taken for columns would give another product.
        assert_ne!(m.transpose() * v, vec(1.0, -1.0, -2.0));
    }

    #[test]
    fn elements_by_row() {
        // The notes' `matrix.row[1].z = 15.0`: third column of the middle row.
        let mut m = DMat3::ZERO;
        m.col_mut(2)[1] = 15.0;
        assert_eq!(m.row(1), vec(0.0, 0.0, 15.0));
    }

    #[test]
    fn transpose() {
        let m = rows(vec(1.0, 3.0, 2.0), vec(1.0, 2.0, -2.0), vec(-2.0, 0.0, 1.0));
        let t = m.transpose();
        assert_eq!(t.row(0), vec(1.0, 1.0, -2.0));
        assert_eq!(t.row(1), vec(3.0, 2.0, 0.0));
        assert_eq!(t.row(2), vec(2.0, -2.0, 1.0));
        // In general it is not the inverse.
        assert_ne!(t * m, DMat3::IDENTITY);
    }
}

mod rotations {
    use super::*;

    /// V and W of the notes' example, normalised.
    fn example() -> (DVec3, DVec3) {
        (
            vec(1.0, 1.0, 1.0).normalize(),
            vec(1.0, 0.0, 1.0).normalize(),
        )
    }

    #[test]
    fn the_vectors_as_printed() {
        let (v, w) = example();
        assert_eq!(prn(v), "   0.577   0.577   0.577");
        assert_eq!(prn(w), "   0.707   0.000   0.707");
    }

    #[test]
    fn the_matrix_as_printed() {
        let (v, w) = example();
        let m = rotation(v, w);
        assert_eq!(prn(m.row(0)), "   0.707   0.000  -0.707");
        assert_eq!(prn(m.row(1)), "  -0.000   1.000   0.000");
        assert_eq!(prn(m.row(2)), "   0.707   0.000   0.707");
        // Lengths do not matter.
        let longer = rotation(vec(1.0, 1.0, 1.0), vec(1.0, 0.0, 1.0));
        for i in 0..3 {
            assert_close(longer.row(i), m.row(i));
        }
    }

    #[test]
    fn there_and_back_as_printed() {
        let (v, w) = example();
        let m = rotation(v, w);
        let (v3, v4) = (m * v, m * w);
        assert_eq!(prn(v3), "   0.000   0.577   0.816");
        assert_eq!(prn(v4), "   0.000   0.000   1.000");
        let inverse = m.transpose();
        let (v3, v4) = (inverse * v3, inverse * v4);
        assert_eq!(prn(v3), "   0.577   0.577   0.577");
        assert_eq!(prn(v4), "   0.707   0.000   0.707");
    }

    /// Rows and columns are unit vectors at right angles, right-handed, and the transpose is the inverse.
    fn assert_rotation(m: DMat3) {
        for m in [m, m.transpose()] {
            assert_close(m.row(0).cross(m.row(1)), m.row(2));
            for i in 0..3 {
                assert_close(m * m.row(i), DVec3::AXES[i]);
            }
        }
    }

    #[test]
    fn each_row_becomes_its_axis() {
        let (v, w) = example();
        assert_rotation(rotation(v, w));
        assert_rotation(rotation(vec(3.0, 4.0, 5.0), vec(4.0, -1.0, 2.0)));
        assert_rotation(rotation(vec(-1.0, 0.0, 0.0), vec(-9.0, 0.5, 1.0)));
    }

    #[test]
    fn w_to_z_and_v_above() {
        let (v, w) = (vec(3.0, 4.0, 5.0), vec(4.0, -1.0, 2.0));
        let m = rotation(v, w);
        assert_close(m * w, vec(0.0, 0.0, w.length()));
        assert!((m * v).x.abs() < 1e-14 && (m * v).y > 0.0);
    }

    #[test]
    fn orthonormal_vectors_become_x_and_z() {
        let v = vec(0.0, 0.6, 0.8);
        let w = vec(1.0, 0.0, 0.0);
        let m = rotation_of_axes(v, w);
        assert_eq!([m.row(0), m.row(2)], [v, w]);
        // Y = Z × X
        assert_eq!(m.row(1), w.cross(v));
        assert_close(m * v, DVec3::X);
        assert_close(m * w, DVec3::Z);
        assert_rotation(m);
        assert_eq!(rotation_of_axes(DVec3::X, DVec3::Z), DMat3::IDENTITY);
    }
}

/// The notes: every operation works when output and input are the same vector. By value that cannot fail unless an
/// operation reads what it has begun to write, as theirs did; each is held to its answer into another vector.
mod aliasing {
    use super::*;

    fn in_place<T: Copy + PartialEq + std::fmt::Debug>(input: T, f: impl Fn(T) -> T) {
        let elsewhere = f(input);
        let mut v = input;
        v = f(v);
        assert_eq!(v, elsewhere);
        assert_ne!(v, input, "an operation that does nothing shows nothing");
    }

    #[test]
    fn every_operation() {
        let a = vec(3.0, 4.0, 5.0);
        let b = vec(4.0, -1.0, 2.0);
        let n = vec(1.0, 2.0, -2.0) / 3.0;
        let m = rotation(a, b);
        in_place(a, |v| 2.0 * v);
        in_place(a, |v| v + v);
        in_place(a, |v| v - b);
        in_place(b, |v| a - v);
        in_place(a, DVec3::normalize);
        in_place(a, |v| v.cross(b));
        in_place(b, |v| a.cross(v));
        in_place(a, |v| project(n, v));
        in_place(n, |v| project(v, a));
        in_place(a, |v| reflect(v, n));
        in_place(n, |v| reflect(a, v));
        in_place(a, |v| m * v);
        in_place(m, |m| m.transpose());
    }

    #[test]
    fn the_answers_of_the_notes_in_place() {
        let mut v = vec(3.0, 4.0, 5.0);
        v = v.normalize();
        assert_eq!(prn(v), "   0.424   0.566   0.707");
        let mut w = vec(0.0, -1.0, 0.0);
        w = vec(1.0, 1.0, 1.0).cross(w);
        assert_eq!(w, vec(1.0, 0.0, -1.0));
        let mut p = vec(1.0, 1.0, 1.0);
        p = project(DVec3::Y, p);
        assert_eq!(p, vec(1.0, 0.0, 1.0));
        let mut m = rows(vec(1.0, 3.0, 2.0), vec(1.0, 2.0, -2.0), vec(-2.0, 0.0, 1.0));
        m = m.transpose();
        assert_eq!(
            m,
            rows(vec(1.0, 1.0, -2.0), vec(3.0, 2.0, 0.0), vec(2.0, -2.0, 1.0))
        );
    }

    #[test]
    #[should_panic(expected = "assertion")]
    fn an_operation_that_reads_what_it_wrote_is_noticed() {
        // The notes' wrong `vec_unit`: the length is taken again after x has been written.
        let mut v = vec(3.0, 4.0, 5.0);
        v.x /= v.length();
        v.y /= v.length();
        v.z /= v.length();
        assert_eq!(prn(v), "   0.424   0.566   0.707");
    }
}

mod a_wrong_answer_is_noticed {
    use super::*;

    #[test]
    #[should_panic(expected = "0.425")]
    fn in_the_last_digit() {
        assert_eq!(
            prn(vec(3.0, 4.0, 5.0).normalize()),
            "   0.425   0.566   0.707"
        );
    }

    #[test]
    #[should_panic(expected = "is not")]
    fn in_a_sign() {
        assert_close(reflect(-DVec3::Y, DVec3::Y), -DVec3::Y);
    }

    #[test]
    fn in_the_order_of_the_operands() {
        let (v, w) = (vec(1.0, 1.0, 1.0), vec(1.0, 0.0, 1.0));
        assert_ne!(rotation(w, v), rotation(v, w));
        assert_ne!(project(v.normalize(), w), project(w.normalize(), v));
        assert_ne!(rotation_of_axes(DVec3::Z, DVec3::X), DMat3::IDENTITY);
    }
}
