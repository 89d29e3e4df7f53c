//! Polygons cut into triangles: ears are cut off one by one (Meisters 1975), in the plane that the
//! polygon's mean normal (Newell; Sutherland, Sproull and Schumacker 1974) is steepest to.

use luc_core::math::Vec3;

/// Twice the area of a triangle of the plane, positive if it runs anticlockwise.
fn area([a, b, c]: [[f64; 2]; 3]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// The triangles of a polygon, by the indices of its corners; two fewer than it has corners. A polygon
/// that crosses itself gets some triangles too.
pub fn triangles(points: &[Vec3]) -> Vec<[usize; 3]> {
    let flat = flattened(points);
    let mut left: Vec<usize> = (0..points.len()).collect();
    let mut out = Vec::new();
    while left.len() > 3 {
        let count = left.len();
        let at = |k: usize| [left[(k + count - 1) % count], left[k], left[(k + 1) % count]];
        // The blunt first corner of a fan is as good as any where there is no ear.
        let ear = (0..count).map(|k| (k + 1) % count).find(|&k| is_ear(&flat, &left, at(k))).unwrap_or(1);
        out.push(at(ear));
        left.remove(ear);
    }
    out.extend(<[usize; 3]>::try_from(left).ok());
    out
}

/// The polygon in the plane, anticlockwise.
fn flattened(points: &[Vec3]) -> Vec<[f64; 2]> {
    let points: Vec<[f64; 3]> = points.iter().map(|p| p.to_array().map(f64::from)).collect();
    let mut normal = [0.0_f64; 3];
    for (i, a) in points.iter().enumerate() {
        let b = points[(i + 1) % points.len()];
        for (k, n) in normal.iter_mut().enumerate() {
            let (u, v) = ((k + 1) % 3, (k + 2) % 3);
            *n += (a[u] - b[u]) * (a[v] + b[v]);
        }
    }
    let steepest = (0..3).max_by(|&i, &k| normal[i].abs().total_cmp(&normal[k].abs())).unwrap_or(0);
    let (mut u, mut v) = ((steepest + 1) % 3, (steepest + 2) % 3);
    if normal[steepest] < 0.0 {
        std::mem::swap(&mut u, &mut v);
    }
    points.iter().map(|p| [p[u], p[v]]).collect()
}

/// Whether a corner bulges out and no other corner lies in its triangle.
fn is_ear(flat: &[[f64; 2]], left: &[usize], three: [usize; 3]) -> bool {
    let [a, b, c] = three.map(|i| flat[i]);
    let inside = |p: [f64; 2]| [[a, b, p], [b, c, p], [c, a, p]].into_iter().all(|t| area(t) >= 0.0);
    area([a, b, c]) > 0.0 && !left.iter().any(|i| !three.contains(i) && inside(flat[*i]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f32::consts::TAU;

    fn areas(points: &[Vec3]) -> (f32, f32) {
        let of = |[a, b, c]: [usize; 3]| 0.5 * (points[b] - points[a]).cross(points[c] - points[a]);
        let cut: Vec<Vec3> = triangles(points).into_iter().map(of).collect();
        let sum: Vec3 = cut.iter().copied().sum();
        (sum.length(), cut.iter().map(|n| n.length()).sum())
    }

    #[test]
    fn triangles_cover_a_star_once_in_any_plane_and_either_way_around() {
        for (u, v) in [(Vec3::X, Vec3::Y), (Vec3::Y, Vec3::X), (Vec3::Z, Vec3::new(0.6, 0.8, 0.1))] {
            let star: Vec<Vec3> = (0..14)
                .map(|k| {
                    let (sin, cos) = (k as f32 / 14.0 * TAU).sin_cos();
                    (u * cos + v * sin) * if k % 2 == 0 { 2.0 } else { 0.7 }
                })
                .collect();
            assert_eq!(triangles(&star).len(), 12);
            // Where triangles overlap or lie outside, the sum of areas is more than the area.
            let (area, sum) = areas(&star);
            assert!((area - sum).abs() < 1e-4 * area, "{area} {sum}");
        }
    }

    #[test]
    fn what_is_no_polygon_gets_triangles_too() {
        assert_eq!(triangles(&[Vec3::ZERO; 3]), [[0, 1, 2]]);
        assert_eq!(triangles(&[Vec3::ONE; 7]).len(), 5);
        let bow = [Vec3::ZERO, Vec3::new(1.0, 1.0, 0.0), Vec3::X, Vec3::Y];
        assert_eq!(triangles(&bow).len(), 2);
    }
}
