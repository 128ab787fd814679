//! The visit: what the visitor does, has chosen and has given, and whether anybody is there.

use winit::keyboard::ModifiersState;

use crate::step::command::KioskCommand;
use crate::step::inbox::Inbox;
use crate::visitor::dwell::Dwell;
use crate::visitor::given::Given;
use crate::visitor::input::Visitor;
use crate::visitor::needs::Needs;
use soffio_config::Config;

/// Whoever stands before the kiosk.
pub(crate) struct Visit {
    pub visitor: Visitor,
    pub modifiers: ModifiersState,
    pub needs: Needs,
    pub dwell: Dwell,
    /// Has no visitor switched the microphone off?
    pub listens: bool,
    pub given: Given,
    /// Does attract mode play?
    attracts: bool,
    /// Was somebody here at the last picture?
    visited: bool,
}

impl Visit {
    /// Nobody has come yet; `given` is the breath of the day.
    pub fn new(config: &Config, given: Given) -> Self {
        Self {
            visitor: Visitor::default(),
            modifiers: ModifiersState::default(),
            needs: Needs::of(&config.visit),
            dwell: Dwell::default(),
            listens: true,
            given,
            attracts: false,
            visited: false,
        }
    }

    /// Tells the simulation what the visitor does; `menu`: the page is open.
    pub fn tell(&mut self, inbox: &mut Inbox, config: &Config, menu: bool) {
        self.visitor.lifts().into_iter().for_each(|lift| inbox.send(KioskCommand::Lift(lift)));
        let controls = &mut inbox.controls;
        controls.aim = self.visitor.aim();
        controls.stick = self.visitor.stick().map(|tilt| tilt * config.controllers.stick_speed);
        controls.hold = self.visitor.holds_key();
        controls.presses.clear();
        controls.presses.extend(self.visitor.presses());
        controls.keyed = self.visitor.keyed();
        controls.press_once = self.needs.once() && !menu;
        (controls.calm, controls.round) = (self.needs.calm, self.needs.round);
        controls.activity = self.visitor.activity();
        controls.deaf = !self.listens;
    }

    /// Looks whether the visit is over: attract mode begins or, where the site has none, nobody is here any more.
    pub fn ends(&mut self, attracts: bool, visited: bool, config: &Config) -> bool {
        let leaves = if config.attract.enabled { attracts && !self.attracts } else { self.visited && !visited };
        self.visited = visited;
        if attracts != self.attracts {
            tracing::info!("{}", if attracts { "nobody is here: attract mode begins" } else { "somebody is here" });
        }
        self.attracts = attracts;
        leaves
    }

    /// The visitor has left: the next one finds everything as it was first.
    pub fn leave(&mut self, config: &Config) {
        self.visitor.leave();
        self.listens = true;
        self.needs = Needs::of(&config.visit);
        self.given.leave();
    }
}
