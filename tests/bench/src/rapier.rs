//! Scenes in Rapier: impulse joints, and reduced coordinates.
//!
//! As its users set it, but for what would hide motion: no sleeping, no speed or spin cap, no continuous collision
//! detection, no joint damping; gyroscopic forces on. Impulse joints know no gears, so scenes with couplings run in
//! reduced coordinates only. Scenes that collide or have limits are not run. Joint frames are chosen so that every joint's turn is zero at the start; the frames' x
//! axis is the axis of a hinge or slider.

/// The same code for the crate in f32 and in f64.
macro_rules! engine {
    ($module:ident, $rapier:ident) => {
        /// Rapier in one precision.
        pub mod $module {
            use $rapier::prelude::*;
            use soffio_math::{DQuat, DVec3};
            use soffio_offline::scene::{BodyState, Engine, JointKind, PhysicsScene};

            struct World {
                world: PhysicsWorld,
                bodies: Vec<RigidBodyHandle>,
            }

            fn vector(v: DVec3) -> Vector {
                Vector::new(v.x as Real, v.y as Real, v.z as Real)
            }

            fn quaternion(q: DQuat) -> Rotation {
                Rotation::from_xyzw(q.x as Real, q.y as Real, q.z as Real, q.w as Real).normalize()
            }

            fn pose(position: DVec3, rotation: DQuat) -> Pose {
                Pose::from_parts(vector(position), quaternion(rotation))
            }

            fn wide(v: Vector) -> DVec3 {
                DVec3::new(f64::from(v.x), f64::from(v.y), f64::from(v.z))
            }

            impl Engine for World {
                fn step(&mut self) -> bool {
                    self.world.step();
                    true
                }

                fn substeps(&self) -> u32 {
                    self.world.integration_parameters.num_solver_iterations as u32
                }

                fn states(&self, out: &mut Vec<BodyState>) {
                    out.clear();
                    out.extend(self.bodies.iter().map(|&handle| {
                        let body = &self.world.bodies[handle];
                        let q = body.rotation();
                        let rotation = [q.x, q.y, q.z, q.w].map(f64::from);
                        BodyState {
                            position: wide(body.translation()),
                            rotation: DQuat::from_array(rotation).normalize(),
                            velocity: wide(body.linvel()),
                            angular_velocity: wide(body.angvel()),
                        }
                    }));
                }
            }

            /// Parent's state, turn of the joint's frame in the parent, and in the child.
            fn frames(scene: &PhysicsScene, joint: usize) -> (BodyState, DQuat, DQuat) {
                let joint = &scene.joints[joint];
                let parent = joint.parent().map_or(BodyState::WORLD, |body| scene.bodies[body].state());
                let first = joint.axes().map_or(DQuat::IDENTITY, |(axis, _)| DQuat::from_rotation_arc(DVec3::X, axis));
                let child = scene.bodies[joint.b].state().rotation;
                (parent, first, child.conjugate() * (parent.rotation * first))
            }

            fn build(scene: &PhysicsScene, dt: f64, substeps: usize, warm: bool, reduced: bool) -> Option<World> {
                let mut world = PhysicsWorld::new();
                world.gravity = vector(DVec3::from_array(scene.gravity));
                world.integration_parameters = IntegrationParameters {
                    dt: dt as Real,
                    num_solver_iterations: substeps,
                    warmstart_joints: warm,
                    normalized_max_linear_velocity: Real::MAX,
                    max_ccd_substeps: 0,
                    ..IntegrationParameters::default()
                };
                let ground = world.insert_body(RigidBodyBuilder::fixed());
                let mut bodies = Vec::new();
                for body in &scene.bodies {
                    let state = body.state();
                    let inertia = vector(DVec3::from_array(body.inertia));
                    let builder = RigidBodyBuilder::dynamic()
                        .pose(pose(state.position, state.rotation))
                        .linvel(vector(state.velocity))
                        .angvel(vector(state.angular_velocity))
                        .additional_mass_properties(MassProperties::new(Vector::ZERO, body.mass as Real, inertia))
                        .allow_fast_rotation(true)
                        .gyroscopic_forces_enabled(true)
                        .can_sleep(false);
                    bodies.push(world.insert_body(builder));
                }
                let mut root = None;
                for (index, joint) in scene.joints.iter().enumerate() {
                    let (_, first, second) = frames(scene, index);
                    let locked = match joint.kind {
                        JointKind::Spherical => JointAxesMask::LOCKED_SPHERICAL_AXES,
                        JointKind::Hinge => JointAxesMask::LOCKED_REVOLUTE_AXES,
                        JointKind::Slider => JointAxesMask::LOCKED_PRISMATIC_AXES,
                    };
                    let data = GenericJointBuilder::new(locked)
                        .local_frame1(pose(DVec3::from_array(joint.anchor_a), first))
                        .local_frame2(pose(DVec3::from_array(joint.anchor_b), second))
                        .build();
                    let parent = joint.parent().map_or(ground, |body| bodies[body]);
                    if reduced {
                        root = Some(world.multibody_joints.insert(parent, bodies[joint.b], data, true)?);
                    } else {
                        world.impulse_joints.insert(parent, bodies[joint.b], data, true);
                    }
                }
                if let Some(any) = root {
                    reduce(scene, &mut world, &bodies, any)?;
                }
                Some(World { world, bodies })
            }

            /// Speeds and couplings of a scene in reduced coordinates.
            fn reduce(
                scene: &PhysicsScene,
                world: &mut PhysicsWorld,
                bodies: &[RigidBodyHandle],
                any: MultibodyJointHandle,
            ) -> Option<()> {
                let links: Vec<_> = bodies
                    .iter()
                    .map(|&handle| world.multibody_joints.rigid_body_link(handle).map(|link| link.id))
                    .collect::<Option<_>>()?;
                let (multibody, _) = world.multibody_joints.get_mut(any)?;
                // Makes the root fixed, which settles where each joint's coordinates lie.
                multibody.forward_kinematics(&world.bodies, true);
                multibody.damping_mut().fill(0.0);
                for (index, joint) in scene.joints.iter().enumerate() {
                    let at = multibody.link(links[index])?.assembly_id();
                    let (parent, first, _) = frames(scene, index);
                    let child = scene.bodies[joint.b].state();
                    let seen = |v: DVec3| (parent.rotation * first).conjugate() * v;
                    let spin = seen(child.angular_velocity - parent.angular_velocity);
                    let moving = |state: &BodyState, point: DVec3| {
                        state.velocity + state.angular_velocity.cross(point - state.position)
                    };
                    let point = child.point(joint.anchor_b);
                    let speeds: &[f64] = match joint.kind {
                        JointKind::Spherical => &spin.to_array(),
                        JointKind::Hinge => &[spin.x],
                        JointKind::Slider => &[seen(moving(&child, point) - moving(&parent, point)).x],
                    };
                    for (k, &speed) in speeds.iter().enumerate() {
                        multibody.generalized_velocity_mut()[at + k] = speed as Real;
                    }
                }
                for coupling in &scene.couplings {
                    let &[(first, c1), (second, c2)] = &coupling.terms[..] else { return None };
                    // Coordinates are counted along and about x; angles come after the three ways.
                    let axis = |joint: usize| if scene.joints[joint].kind == JointKind::Slider { 0 } else { 3 };
                    multibody.add_dof_coupling(MultibodyDofCoupling {
                        link1: links[first],
                        dof1: 0,
                        axis1: axis(first),
                        link2: links[second],
                        dof2: 0,
                        axis2: axis(second),
                        coeff: (-c1 / c2) as Real,
                        offset: 0.0,
                    });
                }
                Some(())
            }

            /// Impulse joints, `substeps` a step; `None` for scenes with couplings or contacts.
            pub fn impulse(scene: &PhysicsScene, dt: f64, substeps: usize, warm: bool) -> Option<Box<dyn Engine>> {
                let runs = crate::articulated(scene) && scene.couplings.is_empty();
                runs.then(|| build(scene, dt, substeps, warm, false))?.map(|world| Box::new(world) as Box<dyn Engine>)
            }

            /// Reduced coordinates with the default substeps; `None` for figures too large for it or with contacts.
            pub fn multibody(scene: &PhysicsScene, dt: f64) -> Option<Box<dyn Engine>> {
                let runs = crate::articulated(scene) && scene.bodies.len() <= crate::MULTIBODY_MOST;
                runs.then(|| build(scene, dt, 4, false, true))?.map(|world| Box::new(world) as Box<dyn Engine>)
            }
        }
    };
}

engine!(single, rapier3d);
engine!(double, rapier3d_f64);
