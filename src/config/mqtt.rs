//! Settings of the MQTT connection to a broker in the museum's network.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

/// Port of a broker that names none.
const PORT: u16 = 1883;

/// Broker to which the kiosk reports its state, and from which it takes commands.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct MqttSettings {
    /// Host or host:port; empty for none.
    pub broker: String,
    /// Prefix of its topics, one for each kiosk.
    pub topic: String,
    /// User name at the broker; empty where none is needed.
    pub user: String,
    /// Password, sent unencrypted.
    pub password: String,
    /// File that holds the password instead, relative to the folder of the configuration; empty for none.
    pub password_file: PathBuf,
    /// Commands that are accepted.
    pub obeys: Vec<MqttOrder>,
}

/// A command that a broker's message may give.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum MqttOrder {
    /// Reload the exhibit on show from its files.
    Reload,
    /// Black screen, no sound, the microphone off.
    Blank,
    /// The end of that.
    Wake,
    /// Mute or unmute.
    Mute,
    /// Show another exhibit.
    Exhibit,
}

impl Default for MqttSettings {
    fn default() -> Self {
        use MqttOrder::{Blank, Exhibit, Mute, Reload, Wake};
        Self {
            broker: String::new(),
            topic: "soffio".into(),
            user: String::new(),
            password: String::new(),
            password_file: PathBuf::new(),
            obeys: vec![Reload, Blank, Wake, Mute, Exhibit],
        }
    }
}

impl MqttSettings {
    /// Host and port; `None` where there is no broker.
    pub fn address(&self) -> Option<(&str, u16)> {
        let (host, port) = match self.broker.rsplit_once(':') {
            Some((host, port)) => (host, port.parse().ok()?),
            None => (self.broker.as_str(), PORT),
        };
        (!host.is_empty()).then_some((host, port))
    }

    /// What is wrong with the broker's address, and what to do.
    pub(super) fn broker_problem(&self) -> Option<(String, String)> {
        let bad = !self.broker.is_empty() && self.address().is_none() || self.broker.contains(['/', ' ']);
        let help = "give a host such as \"broker.museum\", with its port after a colon where it is not 1883, or leave it empty";
        bad.then(|| (format!("\"{}\" is no host and port", self.broker), help.into()))
    }

    /// What is wrong with the password, and what to do.
    pub(super) fn password_problem(&self) -> Option<(String, String)> {
        let twice = !self.password.is_empty() && !self.password_file.as_os_str().is_empty();
        let help = "keep the file and delete mqtt.password, so that the configuration holds no secret";
        twice.then(|| ("mqtt.password and mqtt.password_file both give a password".into(), help.into()))
    }

    /// What is wrong with the topic, and what to do.
    pub(super) fn topic_problem(&self) -> Option<(String, String)> {
        let bad = self.topic.is_empty() || self.topic.starts_with('$') || self.topic.contains(['+', '#', '\0']);
        let help = "give a name such as \"museum/hall-2/soffio\", without +, # or a $ before it";
        bad.then(|| (format!("\"{}\" is no topic", self.topic), help.into()))
    }
}
