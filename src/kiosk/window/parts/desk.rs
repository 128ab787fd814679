//! State for staff: the panel, its log, the cursor, and reports about devices.

use crate::live::LiveState;
use crate::staff::StaffPanel;
use crate::staff::log::Log;
use soffio_devices::audio::DeviceState;

/// State for staff.
pub(crate) struct StaffDesk {
    /// The staff panel.
    pub panel: StaffPanel,
    /// The last lines of the log, for the panel.
    pub log: Log,
    /// Is the cursor shown?
    cursor: bool,
    /// Last reported: is the microphone missing, is the loudspeaker missing?
    microphone_missing: bool,
    output_missing: bool,
}

impl StaffDesk {
    /// The panel is closed and nothing is missing.
    pub fn new(log: Log) -> Self {
        Self { panel: StaffPanel::default(), log, cursor: false, microphone_missing: false, output_missing: false }
    }

    /// Shows a message to staff, on the panel and in the log; `time` in s.
    pub fn say(&mut self, time: f64, message: String) {
        tracing::info!("{message}");
        self.panel.show_message(time, message);
    }

    /// Reports missing devices, and their return.
    pub fn report_devices(&mut self, time: f64, frame: &LiveState) {
        if frame.lacks_microphone() != self.microphone_missing {
            self.microphone_missing = frame.lacks_microphone();
            let said = match self.microphone_missing {
                true if frame.load.audio.input == DeviceState::Closed => "the microphone is off",
                true if frame.load.microphone.is_silent() => "the microphone is silent: muted, or its cable is out",
                true => "no microphone: visitors press and hold to blow; `soffio doctor` says more",
                false => "the microphone works",
            };
            self.say(time, said.into());
        }
        if frame.lacks_output() != self.output_missing {
            self.output_missing = frame.lacks_output();
            let said = match self.output_missing {
                true => "no loudspeaker: the exhibit moves in silence; `soffio doctor` says more",
                false => "the loudspeaker works",
            };
            self.say(time, said.into());
        }
    }

    /// Changed visibility of the cursor; `None` where it has not changed.
    pub fn cursor(&mut self) -> Option<bool> {
        let open = self.panel.is_open();
        (std::mem::replace(&mut self.cursor, open) != open).then_some(open)
    }
}
