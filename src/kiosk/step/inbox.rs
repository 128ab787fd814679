//! Input from the window to the simulation: the newest [`Controls`], and a bounded queue of commands.
//!
//! Both are behind one lock, held for a copy only, so that a press that ended and its lift reach the same step. No side waits.
//! The simulation empties the queue 240 times a second, so it is full only when the simulation hangs. Then the oldest commands
//! are dropped and counted.

use std::collections::VecDeque;

use crate::step::command::{Batch, KioskCommand};
use crate::step::controls::Controls;

/// Capacity of the queue, commands.
pub const CAPACITY: usize = 256;

/// Input of the next step.
#[derive(Debug)]
pub struct Inbox {
    /// The continuous inputs; overwrite those that change.
    pub controls: Controls,
    waiting: VecDeque<KioskCommand>,
    dropped: u64,
}

impl Inbox {
    /// An empty queue.
    pub fn new(controls: Controls) -> Self {
        Self { controls, waiting: VecDeque::with_capacity(CAPACITY), dropped: 0 }
    }

    /// Adds a command for the next step. A full queue drops its oldest command.
    pub fn send(&mut self, command: KioskCommand) {
        if self.waiting.len() == CAPACITY {
            self.waiting.pop_front();
            self.dropped += 1;
        }
        self.waiting.push_back(command);
    }

    /// Takes the controls and all waiting commands.
    pub fn take(&mut self) -> (Controls, Batch) {
        let mut batch = Batch::default();
        self.waiting.drain(..).for_each(|command| batch.add(command));
        (self.controls.clone(), batch)
    }

    /// Commands dropped so far.
    pub fn dropped(&self) -> u64 {
        self.dropped
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use soffio_simulation::Command;

    #[test]
    fn levels_stay_and_commands_are_taken_once() {
        let mut inbox = Inbox::new(Controls::default());
        inbox.controls.hold = true;
        inbox.send(KioskCommand::SelfTest);
        inbox.send(KioskCommand::Simulation(Command::Reset));
        let (controls, batch) = inbox.take();
        assert!(controls.hold && batch.self_test && batch.commands == [Command::Reset]);
        let (controls, batch) = inbox.take();
        assert!(controls.hold, "nobody has let go");
        assert!(!batch.self_test && batch.commands.is_empty(), "done is done");
    }

    #[test]
    fn a_full_queue_keeps_the_newest_in_their_order_and_counts_the_rest() {
        const MORE: usize = 3;
        let mut inbox = Inbox::new(Controls::default());
        for number in 0..CAPACITY + MORE {
            inbox.send(KioskCommand::Simulation(Command::Assemble(number as u64)));
        }
        assert_eq!(inbox.dropped(), MORE as u64);
        let newest: Vec<Command> = (MORE..CAPACITY + MORE).map(|number| Command::Assemble(number as u64)).collect();
        assert_eq!(inbox.take().1.commands, newest);
        inbox.send(KioskCommand::SelfTest);
        assert_eq!(inbox.dropped(), MORE as u64, "there is room again");
    }
}
