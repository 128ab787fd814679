//! One line of a benchmark.

use serde::Serialize;

use super::contact::ContactReport;
use super::format::Scene;
use super::measure::Report;
use super::run::{Best, Watched};
use super::times::TimesReport;

/// One line of a benchmark. It has many fields, because it is the table that is written, column by column.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// Who ran it.
    pub engine: String,
    /// Which version.
    pub version: String,
    /// How it was set.
    pub config: String,
    /// Name of the scene.
    pub scene: String,
    /// Bodies.
    pub n: usize,
    /// Step, s.
    pub dt: f64,
    /// Processor time of a step, best of the rounds.
    pub us_per_step: f64,
    /// Processor time of a simulated second.
    pub us_per_sim_s: f64,
    /// Steps of each round.
    pub timed_steps: u64,
    /// Each step's own time.
    #[serde(flatten)]
    pub times: TimesReport,
    /// Simulated over processor time, by the mean step.
    pub real_time_factor: f64,
    /// Simulated seconds of the pass that measures the motion.
    pub sim_s: f64,
    /// Mean substeps of its steps.
    pub substeps: f64,
    /// Bodies that sleep at its end.
    pub asleep: usize,
    /// As [`Report`] has them, and so on down.
    pub max_joint_err_m: f64,
    /// |E − E₀|, relative.
    pub max_energy_drift_rel: f64,
    /// E − E₀ at the end, relative.
    pub final_energy_drift_rel: f64,
    /// s.
    pub diverged_at_s: Option<f64>,
    /// Do the rounds agree bit for bit?
    pub repeat_bitwise: bool,
    /// Weight's speed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub s4_speed_rel_err: Option<f64>,
    /// Weight's way.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub s4_drop_rel_err: Option<f64>,
    /// Phase error of the gears.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub s4_max_coupling_err_m: Option<f64>,
    /// Mean period by straight lines.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub s5_period_err_ppm: Option<f64>,
    /// Mean period by cubics.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub s5_period_err_hermite_ppm: Option<f64>,
    /// Amplitude at the end over that at the start.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub s5_amplitude_ratio: Option<f64>,
    /// Contacts, where the scene collides.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub contacts: Option<ContactReport>,
}

impl Row {
    /// A line from what was measured.
    pub fn new(who: [&str; 3], scene: &Scene, dt: f64, best: &Best, watched: &Watched) -> Self {
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
