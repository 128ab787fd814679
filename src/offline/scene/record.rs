//! Record of a benchmark: one JSON line.

use serde::Serialize;

use super::contact::ContactReport;
use super::format::PhysicsScene;
use super::measure::Report;
use super::run::{Best, Observation};
use super::times::TimesReport;

/// One record of a benchmark, with a field for each column of the output.
#[derive(Clone, Debug, Serialize)]
pub struct BenchRecord {
    /// Name of the engine.
    pub engine: String,
    /// Version of the engine.
    pub version: String,
    /// Settings of the engine.
    pub config: String,
    /// Name of the scene.
    pub scene: String,
    /// Number of bodies.
    pub n: usize,
    /// Step length, s.
    pub dt: f64,
    /// Mean processor time of a step, µs, best of the rounds.
    pub us_per_step: f64,
    /// Processor time of a simulated second, µs.
    pub us_per_sim_s: f64,
    /// Number of steps of each round.
    pub timed_steps: u64,
    /// Times of the single steps.
    #[serde(flatten)]
    pub times: TimesReport,
    /// Simulated time over processor time, by the mean step.
    pub real_time_factor: f64,
    /// Simulated time of the pass that measures the motion, s.
    pub sim_s: f64,
    /// Mean number of substeps of a step.
    pub substeps: f64,
    /// Number of sleeping bodies at the end.
    pub asleep: usize,
    /// Largest joint error over the run, m. This and the following fields are those of [`Report`].
    pub max_joint_err_m: f64,
    /// Largest |E − E₀| over the scene's energy scale; E mechanical energy, E₀ that of the start.
    pub max_energy_drift_rel: f64,
    /// E − E₀ at the end, over the scene's energy scale.
    pub final_energy_drift_rel: f64,
    /// Simulated time at which the motion diverged, s; `None` where it did not.
    pub diverged_at_s: Option<f64>,
    /// Are the rounds bit-identical?
    pub repeat_bitwise: bool,
    /// Relative error of the weight's speed at the end (scene S4).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub s4_speed_rel_err: Option<f64>,
    /// Relative error of the weight's displacement at the end (scene S4).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub s4_drop_rel_err: Option<f64>,
    /// Largest phase error of the gears on their pitch circles, m (scene S4).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub s4_max_coupling_err_m: Option<f64>,
    /// Relative error of the mean period, 10⁻⁶, with zero crossings by linear interpolation (scene S5).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub s5_period_err_ppm: Option<f64>,
    /// Relative error of the mean period, 10⁻⁶, with zero crossings by cubic interpolation (scene S5).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub s5_period_err_hermite_ppm: Option<f64>,
    /// Amplitude at the end over that at the start (scene S5).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub s5_amplitude_ratio: Option<f64>,
    /// Contacts, where the scene collides.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub contacts: Option<ContactReport>,
}

impl BenchRecord {
    /// The record of a measurement.
    pub fn new(who: [&str; 3], scene: &PhysicsScene, dt: f64, best: &Best, watched: &Observation) -> Self {
        let [engine, version, config] = who.map(str::to_owned);
        let Report { weight, pendulum, contacts, .. } = watched.report;
        let times = watched.times.report();
        Self {
            engine,
            version,
            config,
            scene: scene.name.clone(),
            n: scene.bodies.len(),
            dt,
            us_per_step: best.us_per_step(),
            us_per_sim_s: best.us_per_step() / dt,
            timed_steps: best.steps(),
            real_time_factor: 1e6 * dt / times.mean_us,
            times,
            sim_s: watched.sim_s,
            substeps: watched.substeps,
            asleep: watched.asleep,
            max_joint_err_m: watched.report.max_joint_err_m,
            max_energy_drift_rel: watched.report.max_energy_drift_rel,
            final_energy_drift_rel: watched.report.final_energy_drift_rel,
            diverged_at_s: watched.report.diverged_at_s,
            repeat_bitwise: best.agree(),
            s4_speed_rel_err: weight.map(|w| w.speed_rel_err),
            s4_drop_rel_err: weight.map(|w| w.drop_rel_err),
            s4_max_coupling_err_m: weight.map(|w| w.max_coupling_err_m),
            s5_period_err_ppm: pendulum.map(|p| p.period_err_ppm),
            s5_period_err_hermite_ppm: pendulum.map(|p| p.period_err_hermite_ppm),
            s5_amplitude_ratio: pendulum.map(|p| p.amplitude_ratio),
            contacts,
        }
    }
}
