//! What eight rays have hit: points put back onto their surfaces, normals, materials.
//!
//! A point o + t d is off its surface by rounding that grows with t. It is projected back onto
//! the shape, and secondary rays start [`Surface::clearance`] away along the geometric normal: 4
//! units in the last place of the largest coordinate involved, and of the point relative to where
//! the shape is measured from (Wächter and Binder, Ray Tracing Gems ch. 6; PBRT 4th ed. §6.8.6).

use super::field::{Nodes, locate as on_field};
use super::ramp::ramp;
use super::texture::texture;
use super::voxels::locate as on_voxels;
use super::{Rays8, Shape};
use crate::counters::{Counter, Counters};
use crate::features;
use crate::math::lanes::{Bound, F, V3, splat};
use crate::math::whole;
use crate::mesh::on_surface;
use crate::quality::Quality;
use crate::scene::{Channel, Field, Join, Material, Pattern, Scene, Sphere};

/// The patterns but noise, each with what counts it.
pub const PATTERNS: [(Pattern, Counter); 4] = [
    (Pattern::Cells, Counter::Cells),
    (Pattern::Stripes, Counter::Stripes),
    (Pattern::Brick, Counter::Brick),
    (Pattern::Scratches, Counter::Scratches),
];

/// Surfaces of a packet. Lanes without a hit hold finite nonsense.
pub struct Surface {
    /// Point on the surface, world.
    pub point: V3,
    /// Unit normal for shading, on the side the ray came from.
    pub normal: V3,
    /// Unit geometric normal, on the side the ray came from.
    pub facing: V3,
    /// Mask of rays that met the surface from behind: from inside a body.
    pub inside: F,
    /// Weights of the second and third corner of a mesh's triangle, else 0.
    pub uv: [F; 2],
    /// How far off the surface a secondary ray must start, world units.
    pub clearance: F,
    /// Node of a field that has most of the surface; 0 on other shapes.
    pub node: F,
    /// Which of a field's sharply joined parts that is; of a grid of voxels, which plane of faces of
    /// one value; on a mesh that stands for something curved,
    /// the bits in which the hit's id differs from that of its first facet; 0 on other shapes.
    pub part: F,
    /// Material channels, see [`Channel`].
    pub material: [F; Material::CHANNELS],
}

impl Surface {
    /// Unit geometric normal that points out of the body.
    #[inline(always)]
    pub fn outward(&self) -> V3 {
        V3::select(self.inside, -self.facing, self.facing)
    }

    /// One value of the material.
    #[inline(always)]
    pub fn value(&self, channel: Channel) -> F {
        self.material[channel as usize]
    }

    /// Counts the textures that were evaluated for these surfaces.
    #[inline(always)]
    pub fn count(&self, counters: &mut Counters) {
        let lanes = |c| self.value(c).simd_gt(F::ZERO).to_bitmask().count_ones() as usize;
        counters.add(Counter::TextureLookups, lanes(Channel::Grain));
        counters.add(Counter::Bumps, lanes(Channel::Bump));
        let visible = (self.value(Channel::Grain) + self.value(Channel::Bump)).simd_gt(F::ZERO);
        for (pattern, counter) in PATTERNS {
            let own = visible & self.value(Channel::Pattern).simd_eq(splat(pattern as u32 as f32));
            counters.add(counter, own.to_bitmask().count_ones() as usize);
        }
    }

    /// A colour of the material.
    #[inline(always)]
    pub fn colour(&self, channel: Channel) -> V3 {
        let i = channel as usize;
        V3 { x: self.material[i], y: self.material[i + 1], z: self.material[i + 2] }
    }
}

/// Point, outward normal, shading normal and size of the largest coordinate, for one shape.
type Located = (V3, V3, V3, F);

/// Projects `p` onto the plane through `point` with unit normal `n`.
fn onto_plane(p: V3, point: crate::math::Vec3, n: V3) -> Located {
    let point = V3::splat(point);
    (p - n * n.dot(p - point), n, n, point.max_abs())
}

/// The sphere's normals, flowing into its neighbours' as those of a quadratic smooth minimum.
fn blended(scene: &Scene, own: &Sphere, p: V3, n: V3) -> V3 {
    let mut normal = n;
    if own.blend > 0.0 {
        let k = splat(own.blend);
        for other in scene.spheres.iter().filter(|o| o.blend > 0.0 && !std::ptr::eq(*o, own)) {
            let v = p - V3::splat(other.centre);
            let len = v.length();
            let distance = (len - splat(other.radius)).abs();
            let h = (k - distance).at_least(F::ZERO) / k * splat(0.5);
            normal = normal + (v * (F::ONE / len) - normal) * h;
        }
        normal = normal.normalize();
    }
    normal
}

/// Puts `p` back onto the given part (0 side, 1 near cap, 2 far cap) of a shape.
#[inline(never)]
fn locate(scene: &Scene, shape: Shape, part: u32, p: V3) -> Located {
    match shape {
        Shape::Sphere(s) => {
            let c = V3::splat(s.centre);
            let r = splat(s.radius);
            let n = (p - c).normalize();
            let p = c + n * r;
            (p, n, blended(scene, s, p, n), c.max_abs() + r)
        }
        Shape::Plane(s) => onto_plane(p, s.point, V3::splat(s.normal)),
        Shape::Triangle(s) if features::TRIANGLES => {
            let [a, b, c] = s.corners;
            let n = V3::splat(b - a).cross_exact(V3::splat(c - a));
            // Rounding of the crossing is that of the corners, which may lie far to both sides.
            let reach = V3::splat(a.abs().max(b.abs()).max(c.abs())).max_abs();
            let (point, n, normal, _) = onto_plane(p, a, n.normalize());
            (point, n, normal, reach)
        }
        // Done with all facets of its instance at once.
        Shape::Triangle(_) | Shape::Facet(..) => onto_plane(p, crate::math::Vec3::ZERO, p),
        Shape::Cylinder(s) => round(p, s.base, s.axis, (s.radius, 0.0), [0.0, s.length], part),
        Shape::Cone(s) => round(p, s.apex, s.axis, (0.0, s.slope), s.range, part),
        Shape::Voxels(_) | Shape::Field(_) => onto_plane(p, crate::math::Vec3::ZERO, V3::ZERO),
    }
}

/// [`locate`] for shapes about an axis: radius is `profile.0 + profile.1 * height`.
fn round(
    p: V3,
    reference: crate::math::Vec3,
    axis: crate::math::Vec3,
    profile: (f32, f32),
    range: [f32; 2],
    part: u32,
) -> Located {
    let a = V3::splat(axis);
    if part > 0 {
        let height = range[part as usize - 1];
        let n = if part == 1 { -a } else { a };
        let (point, n, normal, scale) = onto_plane(p, reference + axis * height, n);
        return (point, n, normal, scale + (point - V3::splat(reference)).max_abs());
    }
    let reference = V3::splat(reference);
    let f = p - reference;
    let height = f.dot(a);
    let radial = f - a * height;
    let len = radial.length();
    // On the axis, at a cone's apex, the side has no normal: there it points back along the axis.
    let on_axis = len.simd_eq(F::ZERO);
    let radial = V3::select(on_axis, -a, radial * (F::ONE / on_axis.select(F::ONE, len)));
    let slope = splat(profile.1);
    let scale = (F::ONE + slope * slope).sqrt();
    let n = V3::select(on_axis, radial, (radial - a * slope) * (F::ONE / scale));
    let off = (len - (splat(profile.0) + slope * height)) / scale;
    (p - n * off, n, n, reference.max_abs() + height.abs() + len)
}

/// Locates the surfaces that `rays` hit at distances `t`; ids as in [`super::Hits`]. `spread` is
/// the width of the rays' footprints per unit of distance, which textures are filtered by.
#[inline(never)]
pub fn surface(scene: &Scene, quality: &Quality, rays: &Rays8, t: F, id: F, spread: F) -> Surface {
    let zero = V3::splat(crate::math::Vec3::ZERO);
    let up = V3::splat(crate::math::Vec3::Y);
    let mut s = Surface {
        point: zero,
        normal: up,
        facing: up,
        inside: F::ZERO,
        uv: [F::ZERO; 2],
        clearance: F::ZERO,
        node: F::ZERO,
        part: F::ZERO,
        material: [F::ZERO; Material::CHANNELS],
    };
    let p = rays.origin + rays.direction * t;
    let base = 4.0 * scene.shape_count() as f32;
    let ids = id.to_array();
    let mut todo = id.simd_ge(F::ZERO).to_bitmask();
    while todo != 0 {
        let (first, before) = (todo.trailing_zeros() as usize & 7, todo);
        let lane_id = ids[first];
        let mut mask = id.simd_eq(splat(lane_id));
        todo &= !mask.to_bitmask();
        let (index, part) = (whole(lane_id) >> 2, whole(lane_id) as u32 & 3);
        let shape = scene.shape(index);
        if let (true, Shape::Field(field)) = (features::FIELDS, shape) {
            let found = on_field(field, p, t * spread, rays.direction);
            s.point = V3::select(mask, found.point, s.point);
            s.facing = V3::select(mask, found.outward, s.facing);
            s.normal = V3::select(mask, found.outward, s.normal);
            // Twice what counts as a hit, and the rounding of the point.
            let off = splat(2.5 * quality.epsilon) + found.point.max_abs() * splat(4.0 / 8_388_608.0);
            s.clearance = mask.select(off, s.clearance);
            mix(scene, field, &found.shares, mask, &mut s);
            burn(&scene.materials[shape.material()], mask, &mut s);
            continue;
        }
        let mut material = shape.material();
        let mut shade = F::ONE;
        let mut paint = None;
        let (point, outward, normal, scale) = match shape {
            Shape::Voxels(grid) if features::VOXELS => {
                let face = on_voxels(grid, p, rays.direction, part, t * spread);
                // Cells of one value at a time.
                let value = face.value.as_array()[first];
                mask &= face.value.simd_eq(splat(value));
                todo = before & !mask.to_bitmask();
                material += whole(value).saturating_sub(1);
                s.part = mask.select(face.plane, s.part);
                shade = face.shade;
                (face.point, face.outward, face.outward, V3::splat(grid.lo).max_abs())
            }
            Shape::Facet(instance, _) if features::MESHES => {
                let [first, end] = instance.ids(base);
                mask = id.simd_ge(splat(first)) & id.simd_lt(splat(end));
                todo &= !mask.to_bitmask();
                let facets = instance.facets(rays, (id - splat(first)) * splat(0.25));
                for (uv, of_facets) in s.uv.iter_mut().zip(facets.uv) {
                    *uv = mask.select(of_facets, *uv);
                }
                if let (true, Some(skin)) = (features::IMAGES, instance.mesh().skin()) {
                    let width = on_surface(t * spread, facets.outward, rays.direction);
                    paint = Some(instance.painted(skin, (id - splat(first)) * splat(0.25), facets.uv, width));
                }
                if instance.mesh().is_smooth() {
                    s.part = mask.select(id ^ splat(first), s.part);
                }
                (facets.point, facets.outward, facets.normal, facets.reach)
            }
            _ => locate(scene, shape, part, p),
        };
        s.point = V3::select(mask, point, s.point);
        s.facing = V3::select(mask, outward, s.facing);
        s.normal = V3::select(mask, normal, s.normal);
        let scale = scale.at_least(point.max_abs()).at_least(splat(1e-30));
        s.clearance = mask.select(scale * splat(4.0 / 8_388_608.0), s.clearance);
        let material = &scene.materials[material];
        for (lane, value) in s.material.iter_mut().zip(material.channels()) {
            *lane = mask.select(splat(value), *lane);
        }
        if features::VOXELS {
            let factor = mask.select(shade, F::ONE);
            for first in [Channel::Colour, Channel::Emission] {
                for lane in s.material[first as usize..].iter_mut().take(3) {
                    *lane *= factor;
                }
            }
        }
        if let (true, Some(paint)) = (features::IMAGES, paint) {
            let white = V3::splat(crate::math::Vec3::ONE);
            // What is neither diffuse nor glass is metal, whose colour is that of its mirror.
            let metal = material.diffuse <= 0.0 && !material.is_transparent();
            let first = if metal { Channel::F0 } else { Channel::Colour } as usize;
            let factor = V3::select(mask, paint, white);
            for (lane, factor) in s.material[first..].iter_mut().zip([factor.x, factor.y, factor.z]) {
                *lane *= factor;
            }
        }
        burn(material, mask, &mut s);
    }
    s.inside = s.facing.dot(rays.direction).simd_gt(F::ZERO);
    s.normal = V3::select(s.inside, -s.normal, s.normal);
    s.facing = V3::select(s.inside, -s.facing, s.facing);
    texture(&mut s, rays.direction, t * spread);
    s
}

/// Mixes the materials of a field's nodes, and tells which has most.
#[inline(never)]
fn mix(scene: &Scene, field: &Field, shares: &Nodes, mask: F, s: &mut Surface) {
    let mut most = F::ZERO;
    let mut sum = [F::ZERO; Material::CHANNELS];
    let mut part = 0.0;
    for (i, (node, &share)) in field.nodes.iter().zip(shares).enumerate() {
        if i > 0 && node.blend == 0.0 && node.join != Join::Sum {
            part += 1.0;
        }
        if share.simd_le(F::ZERO).all() {
            continue;
        }
        for (lane, value) in sum.iter_mut().zip(scene.materials[node.material].channels()) {
            *lane += share * splat(value);
        }
        let more = mask & share.simd_gt(most);
        most = more.select(share, most);
        s.node = more.select(splat(i as f32), s.node);
        s.part = more.select(splat(part), s.part);
    }
    for (lane, value) in s.material.iter_mut().zip(sum) {
        *lane = mask.select(value, *lane);
    }
}

/// Light of fire that has come to the points.
fn burn(material: &Material, mask: F, s: &mut Surface) {
    if let Some(fire) = &material.fire {
        let away = (s.point - V3::splat(fire.centre)).length() * splat(1.0 / fire.radius);
        let light = ramp(fire.stops, away) * splat(fire.strength);
        for (lane, value) in
            s.material[Channel::Emission as usize..].iter_mut().zip([light.x, light.y, light.z])
        {
            *lane = mask.select(value, *lane);
        }
    }
}
