//! The staff's side: the panel, the log behind it, the cursor for it, and what they are told of devices.

use crate::live::Frame;
use crate::staff::Staff;
use crate::staff::log::Log;
use soffio_devices::audio::DeviceState;

/// What staff have before them.
pub(crate) struct Desk {
    pub panel: Staff,
    pub log: Log,
    /// Is the cursor shown?
    cursor: bool,
    /// What was last said of the microphone and of the loudspeaker: is it missing?
    deaf: bool,
    mute: bool,
}

impl Desk {
    /// The panel is closed and nothing is missing.
    pub fn new(log: Log) -> Self {
        Self { panel: Staff::default(), log, cursor: false, deaf: false, mute: false }
    }

    /// For staff, on the panel and in the log; `time`, s.
    pub fn say(&mut self, time: f64, message: String) {
        tracing::info!("{message}");
        self.panel.say(time, message);
    }

    /// Staff hear of a device that is missing, and of its return.
    pub fn follow_devices(&mut self, time: f64, frame: &Frame) {
        if frame.is_deaf() != self.deaf {
            self.deaf = frame.is_deaf();
            let said = match self.deaf {
                true if frame.load.audio.input == DeviceState::Closed => "the microphone is closed",
                true if frame.load.microphone.is_silent() => "the microphone is silent: muted, or its cable is out",
                true => "no microphone: visitors press and hold to blow; `soffio doctor` says more",
                false => "the microphone listens",
            };
            self.say(time, said.into());
        }
        if frame.is_mute() != self.mute {
            self.mute = frame.is_mute();
            let said = match self.mute {
                true => "no loudspeaker: the exhibit moves in silence; `soffio doctor` says more",
                false => "the loudspeaker sounds",
            };
            self.say(time, said.into());
        }
    }

    /// Whether the cursor is to be shown from now on, where that has changed.
    pub fn cursor(&mut self) -> Option<bool> {
        let open = self.panel.is_open();
        (std::mem::replace(&mut self.cursor, open) != open).then_some(open)
    }
}
