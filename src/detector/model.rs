//! The detector's model: trees that weigh the evidence, and trees that estimate the air's speed.
//!
//! ```text
//! ℓ = Σ trees(x)                 log-odds of breath, nats
//! v = Σ trees(x) + b L           logarithm of the air's speed at the capsule
//! ```
//!
//! L, the level of the loudest band, enters v alone: so gain changes the strength of a breath, never its detection. The pressure of
//! turbulence grows with the square of the speed, so b would be ln 10/40 a decibel if all microphones had the same sensitivity. They
//! do not, and b is what the training finds for microphones of many.

use safetensors::SafeTensors;

use super::features::{COUNT, Inputs};
use super::trees::{Trees, numbers};

/// Trees and the slope of the speed.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    /// Trees of the log-odds.
    pub odds: Trees,
    /// Trees of the speed.
    pub speed: Trees,
    /// b, nats per decibel.
    pub slope: f32,
}

/// Outputs for one frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Output {
    /// ℓ, nats.
    pub log_odds: f64,
    /// v: natural logarithm of the speed at the capsule in m/s.
    pub log_speed: f64,
}

impl Model {
    /// Outputs for a frame, whose loudest band has `level`, dB of full scale.
    pub fn output(&self, inputs: &Inputs, level: f64) -> Output {
        let log_speed = self.speed.sum(inputs) + f64::from(self.slope) * level;
        Output { log_odds: self.odds.sum(inputs), log_speed }
    }

    /// Reads a safetensors file.
    ///
    /// # Errors
    /// Names the tensor that is missing or wrong.
    pub fn read(file: &[u8]) -> Result<Self, String> {
        let file = SafeTensors::deserialize(file).map_err(|error| format!("no safetensors: {error}"))?;
        let [slope] = numbers(&file, "speed.slope")?[..] else {
            return Err("tensor \"speed.slope\" must be one number".to_owned());
        };
        Ok(Self { odds: Trees::read(&file, "odds", COUNT)?, speed: Trees::read(&file, "speed", COUNT)?, slope })
    }

    /// Tensors of the model, as [`Model::read`] wants them.
    pub fn tensors(&self) -> Vec<(String, Vec<f32>)> {
        let slope = ("speed.slope".to_owned(), vec![self.slope]);
        [self.odds.tensors("odds"), self.speed.tensors("speed"), vec![slope]].concat()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gain_changes_the_speed_and_never_the_odds() {
        let model = crate::BlowSettings::default().model;
        let of = |level: f64| model.output(&[0.5; COUNT], level);
        assert_eq!(of(-60.0).log_odds.to_bits(), of(-20.0).log_odds.to_bits());
        assert!(of(-20.0).log_speed > of(-60.0).log_speed);
    }

    #[test]
    fn a_file_that_is_no_model_is_refused_with_a_reason() {
        let file = crate::MODEL;
        assert!(Model::read(file).is_ok());
        assert!(Model::read(&file[..file.len() - 4]).is_err_and(|why| why.contains("no safetensors")));
        let header = String::from_utf8_lossy(&file[8..]).find("odds.leaves").expect("a tensor") + 8;
        let mut renamed = file.to_vec();
        renamed[header] = b'x';
        assert!(Model::read(&renamed).is_err_and(|why| why.contains("tensor \"odds.leaves\"")));
    }
}
