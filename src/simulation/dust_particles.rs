//! Dust particles: passive tracers that every wind advects, lit where they are fast, so that wind is visible.
//!
//! A particle takes on the velocity of the air within a few hundredths of a second; in still air it drifts slowly. The number
//! of particles is constant. One that is too old or too far away reappears elsewhere around the target, or in the breath.
//! It fades out before and in after, so that no jump is visible.

use soffio_math::noise::{Random, perlin3_vector};
use soffio_math::{DVec3, exp, tangents};
use soffio_wind::breath::Breath;

/// Number of particles.
const COUNT: usize = 120;
/// Number of particles that a breath takes.
const BREATH_COUNT: usize = COUNT * 4 / 5;

/// Where particles live and how they follow the air.
struct Tuning {
    /// Half-width of the cube around the view's target in which they appear, m.
    half_width: f64,
    /// Greatest distance from the view's target, m.
    most_distance: f64,
    /// Time constant with which they take on the air's velocity, s.
    time_constant: f64,
    /// Speed of the slow drift, which moves no sculpture, m/s.
    drift_speed: f64,
    drift_seed: u64,
    /// Steps between two samples of that drift and of the undirected wind.
    drift_steps: usize,
    /// A slower particle does not show a breath and is replaced at once, m/s.
    least_breath_speed: f64,
    /// Lifetime around the target, s.
    lifetime: f64,
    /// Lifetime in a breath, s.
    breath_lifetime: f64,
}

const TUNING: Tuning = Tuning {
    half_width: 0.5,
    most_distance: 1.2,
    time_constant: 0.03,
    drift_speed: 0.012,
    drift_seed: 11,
    drift_steps: 24,
    least_breath_speed: 0.05,
    lifetime: 9.0,
    breath_lifetime: 1.1,
};
/// Brightness in still air.
const FAINT: f64 = 0.05;
/// Speed of full brightness, m/s.
const LIT_SPEED: f64 = 0.8;

/// A dust particle as it is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DustParticle {
    /// Position, world, m.
    pub position: [f32; 3],
    /// Velocity, world, m/s.
    pub velocity: [f32; 3],
    /// 0 invisible … 1 bright.
    pub brightness: f32,
}

#[derive(Clone, Copy)]
struct Particle {
    position: DVec3,
    velocity: DVec3,
    /// Slow drift and undirected wind at its place, m/s.
    slow_velocity: DVec3,
    age: f64,
    lifetime: f64,
}

/// Velocity of the air by its parts, as functions of the point (world, m), m/s.
pub struct AirVelocity<D, U> {
    /// Breath, fans and draughts.
    pub directed: D,
    /// Undirected wind, which changes slowly.
    pub undirected: U,
}

/// All dust particles around a view's target.
#[derive(Clone)]
pub struct DustParticles {
    particles: Vec<Particle>,
    random: Random,
    center: DVec3,
    time: f64,
    step: usize,
}

impl DustParticles {
    /// Particles around a point of the world.
    pub fn new(center: DVec3, seed: u64) -> Self {
        let mut random = Random::new(seed);
        let particles = (0..COUNT)
            .map(|_| {
                let mut particle = around_target(&mut random, center);
                particle.age = random.unit() * particle.lifetime;
                particle
            })
            .collect();
        Self { particles, random, center, time: 0.0, step: 0 }
    }

    /// Removes all particles for good.
    pub fn clear(&mut self) {
        self.particles.clear();
    }

    /// Advects the particles for `dt` seconds. A breath, if any, takes particles into itself.
    pub fn advect<D, U>(&mut self, breath: Option<&Breath>, air: AirVelocity<D, U>, dt: f64)
    where
        D: Fn(DVec3) -> DVec3,
        U: Fn(DVec3) -> DVec3,
    {
        self.time += dt;
        self.step += 1;
        if self.particles.is_empty() {
            return;
        }
        let share = 1.0 - exp(-dt / TUNING.time_constant);
        for (index, particle) in self.particles.iter_mut().enumerate() {
            if (index + self.step).is_multiple_of(TUNING.drift_steps) {
                let at = particle.position / 0.2 + DVec3::splat(0.1 * self.time);
                let noise = perlin3_vector(at, TUNING.drift_seed) * TUNING.drift_speed;
                particle.slow_velocity = noise + (air.undirected)(particle.position);
            }
            particle.velocity =
                particle.velocity.lerp((air.directed)(particle.position) + particle.slow_velocity, share);
            particle.position += dt * particle.velocity;
            particle.age += dt;
            let in_breath = breath.filter(|_| index < BREATH_COUNT);
            let slow = particle.velocity.length() < TUNING.least_breath_speed;
            let useless = in_breath.is_some() && particle.lifetime > TUNING.breath_lifetime && slow;
            let far = particle.position.distance_squared(self.center) > TUNING.most_distance * TUNING.most_distance;
            if particle.age > particle.lifetime || useless || far {
                *particle = match in_breath {
                    Some(breath) => within_breath(&mut self.random, breath),
                    None => around_target(&mut self.random, self.center),
                };
            }
        }
    }

    /// The particles as they are drawn.
    pub fn view(&self) -> impl Iterator<Item = DustParticle> {
        self.particles.iter().map(|particle| {
            let phase = (particle.age / particle.lifetime).clamp(0.0, 1.0);
            let fade = 4.0 * phase * (1.0 - phase);
            let lit = (particle.velocity.length() / LIT_SPEED).min(1.0);
            DustParticle {
                position: particle.position.as_vec3().to_array(),
                velocity: particle.velocity.as_vec3().to_array(),
                brightness: ((FAINT + (1.0 - FAINT) * lit) * fade) as f32,
            }
        })
    }
}

/// A new particle in the cube around the target.
fn around_target(random: &mut Random, center: DVec3) -> Particle {
    let offset = DVec3::new(random.signed(), random.signed(), random.signed()) * TUNING.half_width;
    let lifetime = TUNING.lifetime * random.range(0.6, 1.4);
    Particle { position: center + offset, velocity: DVec3::ZERO, slow_velocity: DVec3::ZERO, age: 0.0, lifetime }
}

/// A new particle in the core of the breath, from 8 cm before the lips to behind the sculpture.
fn within_breath(random: &mut Random, breath: &Breath) -> Particle {
    let x = random.range(0.08, 0.75);
    let (t, b) = tangents(breath.direction);
    let across = (t * random.signed() + b * random.signed()) * breath.half_width(x);
    let position = breath.mouth + x * breath.direction + across;
    Particle {
        position,
        velocity: breath.velocity(position),
        slow_velocity: DVec3::ZERO,
        age: 0.0,
        lifetime: TUNING.breath_lifetime * random.range(0.5, 1.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use soffio_wind::breath::SpreadLaw;

    const DT: f64 = 1.0 / 240.0;
    const SEED: u64 = 4;

    fn still(_: DVec3) -> DVec3 {
        DVec3::ZERO
    }

    #[test]
    fn particles_follow_the_air() {
        // A vortex: after some time constants each particle has the velocity of the air at its place, but for its own drift
        // and for the change of the air within the time constant.
        let vortex = |p: DVec3| DVec3::Y.cross(p) * 0.5 + DVec3::Y * 0.1;
        let mut cloud = DustParticles::new(DVec3::ZERO, SEED);
        for _ in 0..60 {
            cloud.advect(None, AirVelocity { directed: vortex, undirected: still }, DT);
        }
        let lag = TUNING.time_constant * 0.5 * 0.5 * TUNING.most_distance;
        let young = |particle: &&Particle| particle.age > 8.0 * TUNING.time_constant;
        let mut seen = 0;
        for particle in cloud.particles.iter().filter(young) {
            let off = particle.velocity.distance(vortex(particle.position));
            assert!(off < 2.0 * TUNING.drift_speed + lag, "seed {SEED}: {off} m/s off the air");
            seen += 1;
        }
        assert!(seen > COUNT / 2, "{seen} particles");
        let before: Vec<(DVec3, f64)> = cloud.particles.iter().map(|s| (s.position, s.age)).collect();
        cloud.advect(None, AirVelocity { directed: vortex, undirected: still }, DT);
        for (particle, (position, age)) in cloud.particles.iter().zip(before) {
            if particle.age > age {
                assert!((particle.position - position - DT * particle.velocity).length() < 1e-12);
            }
        }
    }

    #[test]
    fn undirected_wind_advects_particles() {
        let mut cloud = DustParticles::new(DVec3::ZERO, SEED);
        for _ in 0..2 * TUNING.drift_steps {
            cloud.advect(None, AirVelocity { directed: still, undirected: |_| DVec3::X * 0.2 }, DT);
        }
        let mean = cloud.particles.iter().map(|s| s.velocity.x).sum::<f64>() / COUNT as f64;
        assert!((mean - 0.2).abs() < 0.03, "seed {SEED}: {mean} m/s");
    }

    #[test]
    fn no_particle_is_lost_in_any_wind() {
        let mut cloud = DustParticles::new(DVec3::X, SEED);
        let breath = Breath {
            mouth: DVec3::new(1.0, 0.0, 0.5),
            direction: DVec3::NEG_Z,
            lip_diameter: 0.01,
            speed: 17.0,
            law: SpreadLaw::Jet,
        };
        for step in 0..2400 {
            let blows = Some(&breath).filter(|_| step / 240 % 2 == 0);
            let directed = |p| DVec3::X * 0.8 + blows.map_or(DVec3::ZERO, |b| b.velocity(p));
            cloud.advect(blows, AirVelocity { directed, undirected: still }, DT);
            assert_eq!(cloud.particles.len(), COUNT);
            for particle in cloud.view() {
                let far = DVec3::from(particle.position.map(f64::from)).distance(DVec3::X);
                assert!(far <= TUNING.most_distance + 1e-6, "seed {SEED}: {far} m off in step {step}");
                assert!((0.0..=1.0).contains(&particle.brightness));
            }
        }
    }

    #[test]
    fn a_breath_is_visible_at_once() {
        let mut cloud = DustParticles::new(DVec3::ZERO, SEED);
        let breath = Breath {
            mouth: DVec3::Z * 0.5,
            direction: DVec3::NEG_Z,
            lip_diameter: 0.01,
            speed: 9.0,
            law: SpreadLaw::Jet,
        };
        for _ in 0..24 {
            cloud.advect(Some(&breath), AirVelocity { directed: |p| breath.velocity(p), undirected: still }, DT);
        }
        let carried = cloud.particles.iter().filter(|s| s.velocity.length() > 0.2).count();
        assert!(carried > COUNT / 4, "seed {SEED}: {carried} particles show the breath after a tenth of a second");
    }
}
