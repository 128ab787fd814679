//! Commands from the window to the simulation, each carried out once.

use std::sync::Arc;

use crate::step::instruments::Audition;
use crate::venue::loudness::VolumeRequests;
use crate::venue::site::Site;
use crate::visitor::gesture::Lift;
use soffio_devices::audio::Utterance;
use soffio_exhibit::Exhibit;
use soffio_simulation::Command;

/// A command that is carried out once, at the next step boundary.
#[derive(Clone, Debug)]
pub enum KioskCommand {
    /// A changed configuration to take over.
    Site(Box<Site>),
    /// Another exhibit to show, or the same one, reloaded.
    Exhibit(Arc<Exhibit>),
    /// Run the audio self-test.
    SelfTest,
    /// A press has come up.
    Lift(Lift),
    /// A command of the simulation.
    Simulation(Command),
    /// Play a sound for staff.
    PlaySound(Audition),
    /// Play speech; it replaces speech that is playing.
    PlaySpeech(Utterance),
    /// Change the loudness.
    Loudness(VolumeRequests),
}

/// The commands of one step by kind. Of commands that replace one another the newest counts.
#[derive(Debug, Default)]
pub struct Batch {
    /// A changed configuration.
    pub site: Option<Box<Site>>,
    /// The exhibit to show.
    pub exhibit: Option<Arc<Exhibit>>,
    /// Is the audio self-test requested?
    pub self_test: bool,
    /// Presses that have come up, in their order.
    pub lifts: Vec<Lift>,
    /// For the simulation, in their order.
    pub commands: Vec<Command>,
    /// Sound that staff want to hear.
    pub audition: Option<Audition>,
    /// Speech to play.
    pub words: Option<Utterance>,
    /// All requested changes of the loudness.
    pub loudness: VolumeRequests,
}

impl Batch {
    /// Adds the next command.
    pub fn add(&mut self, command: KioskCommand) {
        match command {
            KioskCommand::Site(site) => self.site = Some(site),
            KioskCommand::Exhibit(exhibit) => self.exhibit = Some(exhibit),
            KioskCommand::SelfTest => self.self_test = true,
            KioskCommand::Lift(lift) => self.lifts.push(lift),
            KioskCommand::Simulation(command) => self.commands.push(command),
            KioskCommand::PlaySound(audition) => self.audition = Some(audition),
            KioskCommand::PlaySpeech(words) => self.words = Some(words),
            KioskCommand::Loudness(wishes) => self.loudness.add(wishes),
        }
    }
}
