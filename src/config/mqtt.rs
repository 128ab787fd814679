//! Settings of the MQTT connection to a broker in the museum's network.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

/// Ports of a broker that names none, without and with encryption (registered by IANA).
const PORTS: [u16; 2] = [1883, 8883];

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
    /// Password; unencrypted without `authority`.
    pub password: String,
    /// File that holds the password instead, relative to the folder of the configuration; empty for none.
    pub password_file: PathBuf,
    /// File of the certificates (PEM) that the broker's own must come from: the connection is encrypted. Empty for none.
    pub authority: PathBuf,
    /// File of the kiosk's own certificate (PEM), for a broker that asks for one; empty for none.
    pub certificate: PathBuf,
    /// File of the private key (PEM) to the kiosk's own certificate.
    pub key: PathBuf,
    /// Commands that are accepted; none by default.
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
        Self {
            broker: String::new(),
            topic: "soffio".into(),
            user: String::new(),
            password: String::new(),
            password_file: PathBuf::new(),
            authority: PathBuf::new(),
            certificate: PathBuf::new(),
            key: PathBuf::new(),
            obeys: Vec::new(),
        }
    }
}

impl MqttSettings {
    /// Host and port; `None` where there is no broker.
    pub fn address(&self) -> Option<(&str, u16)> {
        let (host, port) = match self.broker.rsplit_once(':') {
            Some((host, port)) => (host, port.parse().ok()?),
            None => (self.broker.as_str(), PORTS[usize::from(self.is_encrypted())]),
        };
        (!host.is_empty()).then_some((host, port))
    }

    /// Is the connection encrypted?
    pub fn is_encrypted(&self) -> bool {
        !self.authority.as_os_str().is_empty()
    }

    /// Does the kiosk identify itself by a certificate?
    pub fn has_certificate(&self) -> bool {
        !self.certificate.as_os_str().is_empty()
    }

    /// What is wrong with the kiosk's own certificate, and what to do.
    pub(super) fn certificate_problem(&self) -> Option<(String, String)> {
        let has_key = !self.key.as_os_str().is_empty();
        let problem = match () {
            () if self.has_certificate() != has_key => "one of certificate and key is missing",
            () if self.has_certificate() && !self.is_encrypted() => "a certificate needs an encrypted connection",
            () => return None,
        };
        Some((problem.into(), "give certificate, key and authority, or only authority".into()))
    }

    /// What is wrong with the broker's address, and what to do.
    pub(super) fn broker_problem(&self) -> Option<(String, String)> {
        let bad = !self.broker.is_empty() && self.address().is_none() || self.broker.contains(['/', ' ']);
        let help = "give a host such as \"broker.museum\", with its port after a colon where it is not 1883 (8883 if encrypted), or leave it empty";
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
