//! Bodies that start in walls.

use crate::*;

/// A box of 0.2 m with its centre at a height.
fn box_at(height: f64) -> Body {
    let shape = Primitive::Box { size: DVec3::splat(0.2), divisions: 1 };
    let shape =
        Shape::from_mesh(&shape.mesh().unwrap(), Sampling::Vertices, MassModel::Solid).unwrap();
    Body::new(shape).mass(1.0).position(DVec3::Y * height)
}

fn world(body: Body) -> WorldBuilder {
    World::builder().dt(1e-4).wall(WallPlane { normal: DVec3::Y, offset: 0.0 }).body(body)
}

#[test]
fn a_body_deep_in_a_wall_is_refused_with_the_position_that_would_do() {
    let errors = world(box_at(0.02)).build().unwrap_err();
    let [BuildError::InWall { depth, position, normal, .. }] = &errors.0[..] else {
        panic!("{errors}");
    };
    assert!((depth - 0.08).abs() < 1e-12 && *normal == [0.0, 1.0, 0.0], "{errors}");
    assert!((position[1] - 0.1).abs() < 1e-12, "{errors}");
    assert!(errors.to_string().contains("starts 8.000e-2 m in the wall"), "{errors}");
    world(box_at(position[1])).build().unwrap();
    // for a run that has begun
    world(box_at(0.02)).accept_start_in_walls(true).build().unwrap();
    // no force acts on it
    let driven = box_at(0.02).motion(Motion::Prescribed(Prescribed::default()));
    world(driven).build().unwrap();
}

#[test]
fn a_body_may_start_slightly_in_a_wall_or_as_deep_as_it_rests() {
    // five per cent of the bounding radius of 0.173 m
    world(box_at(0.0915)).build().unwrap();
    world(box_at(0.091)).build().unwrap_err();
    // four springs of 100 N/m carry 9.8 N at 24.5 mm
    let soft = Material { collision_stiffness: 100.0, ..Material::default() };
    world(box_at(0.1 - 0.0245)).material(soft).build().unwrap();
}

#[test]
fn spheres_are_judged_by_their_surface() {
    let ball = |height: f64| {
        let inertia = DMat3::IDENTITY * 0.004;
        let shape = Shape::from_distribution(&[DVec3::ZERO], Mesh::default(), DVec3::ZERO, inertia);
        let surface = Surface::Spheres { radius: 0.1 };
        Body::new(shape.unwrap()).mass(1.0).surface(surface).position(DVec3::Y * height)
    };
    world(ball(0.096)).build().unwrap();
    let errors = world(ball(0.05)).build().unwrap_err();
    assert!(
        matches!(errors.0[..], [BuildError::InWall { depth, .. }] if (depth - 0.05).abs() < 1e-12)
    );
}

#[test]
fn bodies_in_walls_are_pushed_out_on_request() {
    for height in [0.02, -0.05] {
        world(box_at(height)).build().unwrap_err();
        let pushed = world(box_at(height)).overlaps(Overlaps::Push).build().unwrap();
        let at = pushed.body(0).position();
        assert!((at.y - 0.1).abs() < 1e-3 && at.x == 0.0, "{at}");
    }
}
