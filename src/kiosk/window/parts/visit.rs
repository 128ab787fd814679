//! The visit: input, accessibility settings, breath time, and whether a visitor is present.

use winit::keyboard::ModifiersState;

use crate::step::command::KioskCommand;
use crate::step::inbox::Inbox;
use crate::visitor::accessibility::AccessibilitySettings;
use crate::visitor::breath_time::BreathTime;
use crate::visitor::dwell::Dwell;
use crate::visitor::input::Visitor;
use soffio_config::Config;

/// State of a visit.
pub(crate) struct VisitState {
    /// Inputs of the visitor.
    pub visitor: Visitor,
    /// Modifier keys that are held.
    pub modifiers: ModifiersState,
    /// Accessibility settings of this visit.
    pub accessibility: AccessibilitySettings,
    /// Pressing by rest of the pointer.
    pub dwell: Dwell,
    /// Is the microphone on? A visitor can switch it off.
    pub microphone_on: bool,
    /// Breath time of the visit and of the day.
    pub breath_time: BreathTime,
    /// Is attract mode playing?
    attracts: bool,
    /// Was a visitor present at the last frame?
    visited: bool,
}

/// Who is there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Presence {
    /// Does attract mode play?
    pub attracts: bool,
    /// Is a visitor present?
    pub visited: bool,
}

impl VisitState {
    /// Nobody has come yet; `breath_time` is the breath of the day.
    pub fn new(config: &Config, breath_time: BreathTime) -> Self {
        Self {
            visitor: Visitor::default(),
            modifiers: ModifiersState::default(),
            accessibility: AccessibilitySettings::of(&config.visit),
            dwell: Dwell::default(),
            microphone_on: true,
            breath_time,
            attracts: false,
            visited: false,
        }
    }

    /// Writes the visitor's input into the inbox of the simulation; `menu`: the page is open.
    pub fn write_controls(&mut self, inbox: &mut Inbox, config: &Config, menu: bool) {
        self.visitor.lifts().into_iter().for_each(|lift| inbox.send(KioskCommand::Lift(lift)));
        let controls = &mut inbox.controls;
        controls.aim = self.visitor.aim();
        controls.stick = self.visitor.stick().map(|tilt| tilt * config.controllers.stick_speed);
        controls.hold = self.visitor.holds_key();
        controls.presses.clear();
        controls.presses.extend(self.visitor.presses());
        controls.keyed = self.visitor.keyed();
        controls.press_once = self.accessibility.presses_once() && !menu;
        (controls.reduced_motion, controls.look_around) =
            (self.accessibility.reduced_motion, self.accessibility.look_around);
        controls.activity = self.visitor.activity();
        controls.ignore_microphone = !self.microphone_on;
    }

    /// Is the visit over? It ends when attract mode begins or, without attract mode, when nobody is present any more.
    pub fn ends(&mut self, presence: Presence, config: &Config) -> bool {
        let Presence { attracts, visited } = presence;
        let leaves = if config.attract.enabled { attracts && !self.attracts } else { self.visited && !visited };
        self.visited = visited;
        if attracts != self.attracts {
            tracing::info!("{}", if attracts { "attract mode begins" } else { "attract mode ends" });
        }
        self.attracts = attracts;
        leaves
    }

    /// The visitor has left: everything is reset.
    pub fn leave(&mut self, config: &Config) {
        self.visitor.leave();
        self.microphone_on = true;
        self.accessibility = AccessibilitySettings::of(&config.visit);
        self.breath_time.end_visit();
    }
}
