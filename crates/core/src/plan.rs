//! What a frame calls for, derived from its data and never declared by hand.
//!
//! The engine loops over lists, so a kind that is absent costs nothing; the plan names what is
//! present, and the counter that moves when it is at work. A test renders every part of the show and
//! demands 0 of all that its plan doesn't name and more than 0 of all that it names.

use crate::counters::Counter;
use crate::features;
use crate::mesh::Instance;
use crate::quality::{Quality, Rung};
use crate::sample::ROUGH;
use crate::scene::{Field, Figures, LightKind, Material, Pattern, Rules, Scene, Shading};
use crate::shade::MAX_POINTS;
use crate::trace::Shape;

/// The machinery that a frame calls for, as the counters that it moves.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Plan(Vec<Counter>);

impl Plan {
    /// What `scene` calls for at `quality`.
    pub fn of(scene: &Scene, quality: &Quality) -> Plan {
        let materials = || materials(scene);
        let lamps = !scene.lights.is_empty() || !scene.emitters.is_empty();
        let shows = materials().any(|m| m.diffuse > 0.0 || m.specular.max_element() > 0.0);
        let lit = lamps && shows;
        let number = |kind| scene.lights.iter().filter(|light| light.kind == kind).count();
        let (plain, fills) = (number(LightKind::Point), number(LightKind::Fill));
        let soft = scene.soft && quality.shadow_samples > 1 && !scene.emitters.is_empty();
        let lamps_are_hard = fills < scene.lights.len() || (!scene.emitters.is_empty() && !soft);
        let opaque = |field: &Field| {
            !field.shadowless && !scene.materials[Shape::Field(field).material()].is_transparent()
        };
        let penumbra = scene.penumbra() > 0.0 && lamps_are_hard && scene.fields.iter().any(opaque);
        let points = !scene.points.is_empty() && shows;
        let shines = lit || points;
        let chains = quality.depth > 0;
        let ggx = scene.shading == Shading::Ggx;
        let is_rough = |m: &Material| {
            ggx && scene.rough && quality.rough > 0 && m.roughness > ROUGH && !m.is_transparent()
        };
        let reflects = |m: &Material| m.reflection > 0.0 && m.f0.max_element() > 0.0;
        let mirrors = chains && materials().any(reflects);
        let rough = chains && materials().any(|m| reflects(m) && is_rough(m));
        let bounces =
            chains && quality.scatter > 0 && scene.bounces > 0 && materials().any(|m| m.diffuse > 0.0);
        let glass = chains && materials().any(|m| m.is_transparent());
        let adaptive = quality.block > 1;
        let grain = materials().any(|m| m.texture.grain > 0.0);
        let bumps = materials().any(|m| m.texture.bump > 0.0);
        let textured = grain || bumps || !scene.voxels.is_empty();
        let pattern = |p| materials().any(|m| m.texture.is_visible() && m.texture.pattern == p);
        let lamps_shade = fills < scene.lights.len() + scene.emitters.len();
        let marches = scene.smoke.is_some() && quality.smoke > 0.0;
        let shades = marches && lamps_shade && scene.smoke.is_some_and(|smoke| smoke.rules.shaded);
        let known = quality.rung == Rung::Surface || (quality.rung == Rung::Light && textured);
        let titles = scene.split.map(|split| {
            let (rays, height, error) = ([0; 2], 0.5625, 0.0);
            let mut beams = vec![];
            let (_, grade) = (split.titles)(&Figures { split, rays, height, error }, &mut beams);
            (!beams.is_empty(), grade.bloom > 0.0)
        });
        let (writes, glows) = titles.unwrap_or_default();
        let calls = [
            (Counter::PrimaryRays, true),
            (Counter::SphereTests, !scene.spheres.is_empty()),
            (Counter::PlaneTests, !scene.planes.is_empty()),
            (Counter::CylinderTests, scene.cylinders.iter().any(|s| s.length < f32::INFINITY)),
            (Counter::EndlessTests, scene.cylinders.iter().any(|s| s.length == f32::INFINITY)),
            (Counter::ConeTests, !scene.cones.is_empty()),
            (Counter::TriangleTests, !scene.triangles.is_empty()),
            (Counter::VoxelTests, !scene.voxels.is_empty()),
            (Counter::VoxelSteps, scene.voxels.iter().any(|grid| !grid.materials().is_empty())),
            (Counter::FieldTests, !scene.fields.is_empty()),
            (Counter::FieldSteps, !scene.fields.is_empty()),
            (Counter::FieldOcclusion, !scene.fields.is_empty() && scene.occlusion > 0.0),
            (Counter::FieldShadows, lit && penumbra),
            (Counter::NodeVisits, !scene.meshes.is_empty()),
            (Counter::FacetTests, !scene.meshes.is_empty()),
            (Counter::SmoothFacets, scene.meshes.instances().iter().any(|i| i.mesh().is_smooth())),
            (Counter::ImageLookups, scene.meshes.instances().iter().any(|i| i.mesh().skin().is_some())),
            (Counter::ReflectedRays, mirrors),
            (Counter::RefractedRays, glass),
            (Counter::RoughRays, rough),
            (Counter::ScatterRays, bounces),
            (Counter::EmitterTests, (mirrors || glass) && !scene.emitters.is_empty()),
            (Counter::DiscTests, !scene.background.discs.is_empty()),
            (Counter::Glows, !scene.background.glows.is_empty()),
            (Counter::ShadowRays, lit && lamps_shade),
            (Counter::SoftShadowRays, shows && soft),
            (Counter::ColouredShadows, lit && lamps_shade && materials().any(|m| m.is_transparent())),
            (Counter::LightEvaluations, lit),
            (Counter::Phong, shines && scene.shading == Shading::Phong),
            (Counter::CookTorrance, shines && scene.shading == Shading::CookTorrance),
            (Counter::Ggx, shines && scene.shading == Shading::Ggx),
            (Counter::PlainLights, lit && plain > 0),
            (Counter::SpotLights, lit && plain + fills < scene.lights.len()),
            (Counter::RectangleLights, lit && !scene.emitters.is_empty()),
            (Counter::FillLights, lit && fills > 0),
            (Counter::PointLights, points),
            (Counter::TextureLookups, grain),
            (Counter::Cells, pattern(Pattern::Cells)),
            (Counter::Stripes, pattern(Pattern::Stripes)),
            (Counter::Brick, pattern(Pattern::Brick)),
            (Counter::Scratches, pattern(Pattern::Scratches)),
            (Counter::Bumps, bumps),
            (Counter::FogSegments, scene.fog.is_some()),
            (Counter::SmokeCells, scene.smoke.is_some_and(|smoke| smoke.steps > 0)),
            (
                Counter::SmokeSwirled,
                scene.smoke.is_some_and(|smoke| smoke.steps > 0 && smoke.rules.air.swirl > 0.0),
            ),
            (Counter::SmokeShown, scene.smoke.is_some()),
            (Counter::SmokeMarched, marches),
            (Counter::SmokeShadowRays, shades),
            (Counter::Beams, !scene.beams.is_empty() || writes),
            (Counter::KnownSurfaces, adaptive && known && scene.has_known_surfaces()),
            (Counter::Traced, !adaptive || quality.smallest <= 1 || scene.split.is_some()),
            (Counter::Interpolated, adaptive),
            (Counter::Filled, adaptive),
            (Counter::EdgeSamples, quality.edge_samples.max(quality.samples) > 0),
            (Counter::BloomPasses, scene.grade.bloom > 0.0 || glows),
            (Counter::Measured, adaptive && scene.split.is_some()),
            (Counter::OverlayPixels, scene.overlay > 0.0),
        ];
        let effects = scene.effects.iter().filter(|effect| effect.runs()).map(|effect| effect.kind.counter());
        Plan(calls.into_iter().filter_map(|(call, called)| called.then_some(call)).chain(effects).collect())
    }

    /// Whether the frame calls for the machinery behind a counter.
    pub fn names(&self, call: Counter) -> bool {
        self.0.contains(&call)
    }

    /// Everything that is called for.
    pub fn calls(&self) -> &[Counter] {
        &self.0
    }
}

/// What the shapes and meshes of a scene are made of.
fn materials(scene: &Scene) -> impl Iterator<Item = &Material> {
    let shapes = (0..scene.shape_count()).map(|i| scene.shape(i).material());
    let mixed = scene.fields.iter().flat_map(|field| &field.nodes).map(|node| node.material);
    let meshes = scene.meshes.instances().iter().map(|i| i.material);
    let cells = scene.voxels.iter().flat_map(|grid| grid.materials());
    shapes.chain(mixed).chain(meshes).chain(cells).map(|i| &scene.materials[i])
}

/// Named faults of a scene: data that its quality or the engine's limits can't show.
pub fn warnings(scene: &Scene, quality: &Quality) -> Vec<&'static str> {
    let materials = || materials(scene);
    let facets: usize = scene.meshes.instances().iter().map(|i| i.mesh().triangles().len()).sum();
    let clear = |i: &Instance| scene.materials[i.material].is_transparent();
    let spot = |kind: LightKind| matches!(kind, LightKind::Spot { inner, outer, .. } if inner <= outer);
    let smoke = scene.smoke.map(|smoke| smoke.rules);
    // Those that it has, as a part of its state, must be where the scene's lights are.
    let stand = |rules: &Rules| scene.lights.iter().zip(rules.lamps).all(|(light, at)| light.position == at);
    let faults = [
        (quality.depth < 2 && materials().any(|m| m.is_transparent()), "glass needs a depth of two or more"),
        (quality.depth < 1 && materials().any(|m| m.reflection > 0.0), "mirrors need a depth of one or more"),
        (quality.average > 1 && !features::AVERAGE, "averages are left out of this build"),
        (smoke.is_some() && !features::SMOKE, "smoke is left out of this build"),
        (smoke.is_some() && quality.smoke <= 0.0, "smoke needs steps longer than 0 to be seen"),
        (
            smoke.is_some_and(|rules| !stand(rules)),
            "the lamps of the smoke are not where the first lights are",
        ),
        (scene.lights.len() + scene.emitters.len() > 8, "lamps after the eighth cast no shadow"),
        (materials().filter(|m| m.is_transparent()).count() > 23, "glass after the 23rd casts no shadow"),
        (
            scene.fields.iter().any(|f| f.nodes.len() > Field::MOST),
            "nodes of a field after the 32nd are not there",
        ),
        (scene.meshes.instances().iter().any(clear), "meshes of glass cast no shadow"),
        (scene.shape_count() + facets > 1 << 22, "more shapes and facets than ids"),
        (scene.points.len() > MAX_POINTS, "small lights after the 512th do not shine"),
        (scene.lights.iter().any(|l| spot(l.kind)), "a spot's inner cone is wider than its outer one"),
        (scene.background.stops.windows(2).any(|s| s[0].y >= s[1].y), "the sky's stops do not ascend"),
    ];
    faults.into_iter().filter_map(|(found, words)| found.then_some(words)).collect()
}
