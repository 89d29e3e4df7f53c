//! What of a part stands still, as a table: numbers in a table pack in half the bytes of code that
//! writes them. For each frame a scene is made of the table, and the part puts what moves in place.

use luc_core::math::{Vec3, normalize};
use luc_core::scene::*;

/// The still of a part. What it doesn't name is as in [`Still::NOTHING`].
pub struct Still {
    pub stops: &'static [Stop],
    /// Their directions need not be unit vectors.
    pub glows: &'static [Glow],
    pub discs: &'static [Disc],
    pub spheres: &'static [Sphere],
    pub planes: &'static [Plane],
    pub materials: &'static [Material],
    pub lights: &'static [Lamp],
    pub panels: &'static [Panel],
    pub shading: Shading,
    /// Light from below and from above.
    pub ambient: [Vec3; 2],
    pub fog: Option<Fog>,
    pub grade: Grade,
}

/// A lamp: a point, or a spot that is turned to a point and given by the cosines of its cones.
pub struct Lamp {
    pub position: Vec3,
    pub colour: Vec3,
    pub spot: Option<(Vec3, [f32; 2])>,
}

/// A shining rectangle, turned to a point.
pub struct Panel {
    pub centre: Vec3,
    pub target: Vec3,
    /// Width and height.
    pub size: [f32; 2],
    pub radiance: Vec3,
}

impl Still {
    pub const NOTHING: Still = Still {
        stops: &[],
        glows: &[],
        discs: &[],
        spheres: &[],
        planes: &[],
        materials: &[],
        lights: &[],
        panels: &[],
        shading: Shading::Phong,
        ambient: [Vec3::ZERO; 2],
        fog: None,
        grade: Grade::DEFAULT,
    };

    /// A scene of what stands still.
    #[inline(never)]
    pub fn scene(&self) -> Scene {
        let light = |lamp: &Lamp| Light {
            position: lamp.position,
            colour: lamp.colour,
            kind: match lamp.spot {
                None => LightKind::Point,
                Some((target, [inner, outer])) => {
                    LightKind::Spot { direction: normalize(target - lamp.position), inner, outer }
                }
            },
        };
        let emitter = |p: &Panel| Emitter::facing(p.centre, p.target, p.size[0], p.size[1], p.radiance);
        let glow = |g: &Glow| Glow { direction: normalize(g.direction), ..*g };
        Scene {
            background: Background {
                stops: self.stops.to_vec(),
                glows: self.glows.iter().map(glow).collect(),
                discs: self.discs.to_vec(),
            },
            spheres: self.spheres.to_vec(),
            planes: self.planes.to_vec(),
            materials: self.materials.to_vec(),
            lights: self.lights.iter().map(light).collect(),
            emitters: self.panels.iter().map(emitter).collect(),
            shading: self.shading,
            ambient: self.ambient,
            fog: self.fog,
            grade: self.grade,
            ..Scene::new()
        }
    }
}
