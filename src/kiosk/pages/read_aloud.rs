//! Reading aloud: what is said when, and when it ends.
//!
//! A press begins it, and ends it; so does a touch, a key or a breath, whatever else they do. Whoever has had something
//! read in this visit is told the button that the keys are on, too, so that the page can be used without seeing it.

use std::sync::mpsc::{Receiver, channel};

use crate::pages::overlay::Scene;
use crate::pages::speech_synthesis::{PendingSpeech, SpeechSynthesizer};
use crate::pages::speech_text;
use crate::visitor::input::Request;
use soffio_devices::audio::Words;

/// The state of reading aloud.
#[derive(Default)]
pub struct ReadAloud {
    program: String,
    synthesizer: Option<SpeechSynthesizer>,
    /// The program is asked for its languages on a thread of its own: nothing waits for it.
    detecting: Option<Receiver<Result<SpeechSynthesizer, String>>>,
    /// What the next picture shall be asked for: the work, or a button.
    requested: Option<Option<Request>>,
    pending: Option<PendingSpeech>,
    /// Sent to the loudspeaker, which does not say so yet.
    queued: bool,
    playing: bool,
    /// Has anything been read in this visit?
    announces_focus: bool,
}

impl ReadAloud {
    /// Looks for the program where another one is configured; an empty name is none.
    pub fn configure(&mut self, program: &str) {
        if let Some(found) = self.detecting.as_ref().and_then(|finding| finding.try_recv().ok()) {
            self.detecting = None;
            self.synthesizer = found.inspect_err(|error| tracing::info!("nothing is read aloud: {error}")).ok();
        }
        if self.program == program {
            return;
        }
        self.program = program.to_owned();
        (self.synthesizer, self.detecting) = (None, None);
        if !program.is_empty() {
            let (tell, found) = channel();
            let program = program.to_owned();
            // Whoever does not listen any more has another program.
            let find = move || drop(tell.send(SpeechSynthesizer::detect(&program)));
            match std::thread::Builder::new().name("soffio-voices".into()).spawn(find) {
                Ok(_) => self.detecting = Some(found),
                Err(error) => tracing::warn!("nothing is read aloud: {error}"),
            }
        }
    }

    /// Can this language be read?
    pub fn can_speak(&self, language: &str) -> bool {
        self.synthesizer.as_ref().is_some_and(|speaker| speaker.can_speak(language))
    }

    /// Is something being read, or about to be?
    pub fn is_on(&self) -> bool {
        self.requested.is_some() || self.pending.is_some() || self.queued || self.playing
    }

    /// Has the work read, or hushes: words for the loudspeaker.
    pub fn toggle(&mut self) -> Option<Words> {
        if self.is_on() {
            return self.stop();
        }
        self.requested = Some(None);
        None
    }

    /// Keys have reached a button: whoever has had something read is told which.
    pub fn announce_focus(&mut self, button: Option<Request>) {
        if self.announces_focus {
            self.requested = button.map(Some);
        }
    }

    /// Begins to read what was asked for, from what is on the glass, on a loudspeaker of this rate, Hz.
    pub fn start_requested(&mut self, scene: &Scene, sample_rate: u32) {
        let (Some(asked), Some(speaker)) = (self.requested.take(), &self.synthesizer) else { return };
        let mut texts = match asked {
            None => speech_text::exhibit(scene),
            Some(button) => speech_text::button(button, scene),
        };
        texts.retain(|(_, language)| speaker.can_speak(language));
        self.pending = Some(speaker.start(texts, sample_rate));
        self.announces_focus = true;
    }

    /// Ends it: words that hush, where there is something to hush.
    pub fn stop(&mut self) -> Option<Words> {
        let on = self.is_on();
        (self.requested, self.pending, self.queued, self.playing) = (None, None, false, false);
        on.then(|| Words { samples: [].into(), sample_rate: 0 })
    }

    /// The visitor has left.
    pub fn end_visit(&mut self) -> Option<Words> {
        self.announces_focus = false;
        self.stop()
    }

    /// Looks on; `speaks` is what the loudspeaker says. Words that have been made, for the loudspeaker.
    pub fn update(&mut self, speaks: bool) -> Option<Words> {
        // Until the loudspeaker has begun, its silence is not an end.
        self.queued &= !speaks;
        self.playing = speaks;
        let made = self.pending.as_ref()?.poll()?;
        self.pending = None;
        match made {
            Ok(words) => {
                self.queued = !words.samples.is_empty();
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
pub fn keeps_reading(request: Option<Request>) -> bool {
    matches!(request, Some(Request::Speak | Request::Louder(_) | Request::Look(_)))
}
