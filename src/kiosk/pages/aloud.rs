//! Reading aloud: what is said when, and when it ends.
//!
//! A press begins it, and ends it; so does a touch, a key or a breath, whatever else they do. Whoever has had something
//! read in this visit is told the button that the keys are on, too, so that the page can be used without seeing it.

use std::sync::mpsc::{Receiver, channel};

use crate::pages::overlay::Scene;
use crate::pages::speech::{Making, Speaker};
use crate::pages::spoken;
use crate::visitor::input::Request;
use soffio_devices::audio::Words;

/// The state of reading aloud.
#[derive(Default)]
pub struct Aloud {
    program: String,
    speaker: Option<Speaker>,
    /// The program is asked for its languages on a thread of its own: nothing waits for it.
    finding: Option<Receiver<Result<Speaker, String>>>,
    /// What the next picture shall be asked for: the work, or a button.
    asked: Option<Option<Request>>,
    making: Option<Making>,
    /// Sent to the loudspeaker, which does not say so yet.
    sent: bool,
    speaks: bool,
    /// Has anything been read in this visit?
    guides: bool,
}

impl Aloud {
    /// Looks for the program where another one is configured; an empty name is none.
    pub fn settle(&mut self, program: &str) {
        if let Some(found) = self.finding.as_ref().and_then(|finding| finding.try_recv().ok()) {
            self.finding = None;
            self.speaker = found.inspect_err(|error| tracing::info!("nothing is read aloud: {error}")).ok();
        }
        if self.program == program {
            return;
        }
        self.program = program.to_owned();
        (self.speaker, self.finding) = (None, None);
        if !program.is_empty() {
            let (tell, found) = channel();
            let program = program.to_owned();
            // Whoever does not listen any more has another program.
            let find = move || drop(tell.send(Speaker::find(&program)));
            match std::thread::Builder::new().name("soffio-voices".into()).spawn(find) {
                Ok(_) => self.finding = Some(found),
                Err(error) => tracing::warn!("nothing is read aloud: {error}"),
            }
        }
    }

    /// Can this language be read?
    pub fn can_speak(&self, language: &str) -> bool {
        self.speaker.as_ref().is_some_and(|speaker| speaker.can_speak(language))
    }

    /// Is something being read, or about to be?
    pub fn is_on(&self) -> bool {
        self.asked.is_some() || self.making.is_some() || self.sent || self.speaks
    }

    /// Has the work read, or hushes: words for the loudspeaker.
    pub fn press(&mut self) -> Option<Words> {
        if self.is_on() {
            return self.end();
        }
        self.asked = Some(None);
        None
    }

    /// Keys have reached a button: whoever has had something read is told which.
    pub fn reach(&mut self, button: Option<Request>) {
        if self.guides {
            self.asked = button.map(Some);
        }
    }

    /// Begins to read what was asked for, from what is on the glass, on a loudspeaker of this rate, Hz.
    pub fn follow(&mut self, scene: &Scene, sample_rate: u32) {
        let (Some(asked), Some(speaker)) = (self.asked.take(), &self.speaker) else { return };
        let mut texts = match asked {
            None => spoken::work(scene),
            Some(button) => spoken::button(button, scene),
        };
        texts.retain(|(_, language)| speaker.can_speak(language));
        self.making = Some(speaker.make(texts, sample_rate));
        self.guides = true;
    }

    /// Ends it: words that hush, where there is something to hush.
    pub fn end(&mut self) -> Option<Words> {
        let on = self.is_on();
        (self.asked, self.making, self.sent, self.speaks) = (None, None, false, false);
        on.then(|| Words { samples: [].into(), sample_rate: 0 })
    }

    /// The visitor has left.
    pub fn leave(&mut self) -> Option<Words> {
        self.guides = false;
        self.end()
    }

    /// Looks on; `speaks` is what the loudspeaker says. Words that have been made, for the loudspeaker.
    pub fn tend(&mut self, speaks: bool) -> Option<Words> {
        // Until the loudspeaker has begun, its silence is not an end.
        self.sent &= !speaks;
        self.speaks = speaks;
        let made = self.making.as_ref()?.ready()?;
        self.making = None;
        match made {
            Ok(words) => {
                self.sent = !words.samples.is_empty();
                Some(words)
            }
            Err(error) => {
                tracing::warn!("nothing is read aloud: {error}");
                None
            }
        }
    }
}

/// Does what is asked for leave the reading on? Only what is about the reading itself.
pub fn goes_on(request: Option<Request>) -> bool {
    matches!(request, Some(Request::Speak | Request::Louder(_) | Request::Look(_)))
}
