//! The motion of the body of each sound whose timbre follows it, as commands.

use super::motion::Motion;
use super::rate::DT;
use super::sonify::AudioListener;
use soffio_exhibit::{Exhibit, ForceOf};
use soffio_geometry::bodies::RigidBody;
use soffio_math::DVec3;
use soffio_sound::{BodyMotion, MotionSound, SoundCommand};

/// One sound that follows its body's motion.
#[derive(Clone)]
struct Following {
    /// Index of the exhibit's sound.
    sound: usize,
    /// Centre of mass at the start, world, m.
    start: DVec3,
    /// Way since then, m.
    way: f64,
}

/// All sounds of an exhibit that follow motion.
#[derive(Clone)]
pub(crate) struct MotionSounds(Vec<Following>);

impl MotionSounds {
    /// The exhibit's, at its start.
    pub fn new(exhibit: &Exhibit) -> Self {
        let follow = exhibit.sounds.iter().enumerate().filter(|(_, sound)| sound.follows.motion);
        let following = |(sound, binding): (usize, &soffio_exhibit::SoundBinding)| Following {
            sound,
            start: RigidBody::at_rest(exhibit.bodies[binding.body].properties, exhibit.bodies[binding.body].pose)
                .position,
            way: 0.0,
        };
        Self(follow.map(following).collect())
    }

    /// Back to the start.
    pub fn reset(&mut self) {
        self.0.iter_mut().for_each(|following| following.way = 0.0);
    }

    /// Sends the motion of this moment.
    pub fn update(
        &mut self,
        sample: u64,
        exhibit: &Exhibit,
        motion: &Motion,
        listener: &AudioListener,
        out: &mut Vec<SoundCommand>,
    ) {
        for Following { sound, start, way } in &mut self.0 {
            let binding = &exhibit.sounds[*sound];
            let dynamics = motion.of_body(binding.body);
            let RigidBody { position, velocity, angular_velocity, .. } = dynamics.bodies[binding.body];
            *way += velocity.length() * DT;
            let follows = &binding.follows;
            let (mut joint_force, mut tension) = (0.0, 0.0);
            match follows.force {
                Some(ForceOf::Constraint(constraint)) => joint_force = dynamics.joint_load(constraint),
                Some(ForceOf::Spring(spring)) => tension = dynamics.spring_pull(spring),
                None => {}
            }
            let motion = BodyMotion {
                speed: velocity.length() as f32,
                spin: angular_velocity.length() as f32,
                joint_force: joint_force as f32,
                tension: tension as f32,
                way: *way as f32,
                height: (position.y - start.y) as f32,
                parameter: follows.parameter.at(dynamics.time()).value as f32,
            };
            let place = listener.locate(position);
            let instrument = binding.instrument as u16;
            out.push(SoundCommand::Motion(MotionSound {
                sample,
                instrument,
                motion,
                pan: place.pan,
                distance: place.distance,
            }));
        }
    }
}
