//! What happens once: the commands that go from the window to the simulation.

use std::sync::Arc;

use crate::step::voice::Trial;
use crate::venue::loudness::Wishes;
use crate::venue::site::Site;
use crate::visitor::gesture::Lift;
use soffio_devices::audio::Words;
use soffio_exhibit::Exhibit;
use soffio_simulation::Command;

/// One thing to do, once, at the next step boundary.
#[derive(Clone, Debug)]
pub enum KioskCommand {
    /// A changed configuration to take over.
    Site(Box<Site>),
    /// Another exhibit to show, or the same one, reloaded.
    Exhibit(Arc<Exhibit>),
    /// The loudspeaker chirps to the microphone.
    Chirp,
    /// A press has come up.
    Lift(Lift),
    /// A command of the simulation.
    Simulation(Command),
    /// An instrument that staff want to hear.
    Try(Trial),
    /// Words to say in place of those that are being said.
    Say(Words),
    /// What is asked of the loudness.
    Loudness(Wishes),
}

/// The commands that one step takes, by what becomes of them. Of those that replace one another the newest counts.
#[derive(Debug, Default)]
pub struct Batch {
    /// A changed configuration.
    pub site: Option<Box<Site>>,
    /// The exhibit to show.
    pub exhibit: Option<Arc<Exhibit>>,
    /// Is a chirp asked for?
    pub chirp: bool,
    /// Presses that have come up, in their order.
    pub lifts: Vec<Lift>,
    /// For the simulation, in their order.
    pub commands: Vec<Command>,
    /// What staff want to hear.
    pub trial: Option<Trial>,
    /// What is to be said.
    pub words: Option<Words>,
    /// What is asked of the loudness, all together.
    pub loudness: Wishes,
}

impl Batch {
    /// Takes in the next command.
    pub fn add(&mut self, command: KioskCommand) {
        match command {
            KioskCommand::Site(site) => self.site = Some(site),
            KioskCommand::Exhibit(exhibit) => self.exhibit = Some(exhibit),
            KioskCommand::Chirp => self.chirp = true,
            KioskCommand::Lift(lift) => self.lifts.push(lift),
            KioskCommand::Simulation(command) => self.commands.push(command),
            KioskCommand::Try(trial) => self.trial = Some(trial),
            KioskCommand::Say(words) => self.words = Some(words),
            KioskCommand::Loudness(wishes) => self.loudness.add(wishes),
        }
    }
}
