//! Read aloud: when a text is read, and when the reading ends.
//!
//! A press starts the reading. A second press, a touch, a key or a breath ends it. After the first reading of a visit the
//! focused button is announced too, so that the page can be used without seeing it.

use std::sync::mpsc::{Receiver, channel};

use crate::pages::overlay::Scene;
use crate::pages::speech_synthesis::{PendingSpeech, SpeechSynthesizer};
use crate::pages::speech_text;
use crate::visitor::input::Request;
use soffio_devices::audio::Utterance;

/// State of reading aloud.
#[derive(Default)]
pub struct ReadAloud {
    program: String,
    synthesizer: Option<SpeechSynthesizer>,
    /// The speech program is queried for its languages on its own thread.
    detecting: Option<Receiver<Result<SpeechSynthesizer, String>>>,
    /// Request for the next picture: the exhibit (`None`), or a button.
    requested: Option<Option<Request>>,
    pending: Option<PendingSpeech>,
    /// Sent to the output, which does not play it yet.
    queued: bool,
    playing: bool,
    /// Is the focused button announced? From the first reading of a visit on.
    announces_focus: bool,
}

impl ReadAloud {
    /// Looks for the speech program if the configuration names another one. An empty name means no program.
    pub fn configure(&mut self, program: &str) {
        if let Some(found) = self.detecting.as_ref().and_then(|detecting| detecting.try_recv().ok()) {
            self.detecting = None;
            self.synthesizer = found.inspect_err(|error| tracing::info!("nothing is read aloud: {error}")).ok();
        }
        if self.program == program {
            return;
        }
        self.program = program.to_owned();
        (self.synthesizer, self.detecting) = (None, None);
        if !program.is_empty() {
            let (sender, receiver) = channel();
            let program = program.to_owned();
            // The receiver is gone if another program has been configured meanwhile.
            let detect = move || drop(sender.send(SpeechSynthesizer::detect(&program)));
            match std::thread::Builder::new().name("soffio-voices".into()).spawn(detect) {
                Ok(_) => self.detecting = Some(receiver),
                Err(error) => tracing::warn!("nothing is read aloud: {error}"),
            }
        }
    }

    /// Does a voice read this language?
    pub fn can_speak(&self, language: &str) -> bool {
        self.synthesizer.as_ref().is_some_and(|synthesizer| synthesizer.can_speak(language))
    }

    /// Is a text being read, or about to be read?
    pub fn is_on(&self) -> bool {
        self.requested.is_some() || self.pending.is_some() || self.queued || self.playing
    }

    /// Requests a reading of the exhibit, or ends the reading. Returns what the output must play instead.
    pub fn toggle(&mut self) -> Option<Utterance> {
        if self.is_on() {
            return self.stop();
        }
        self.requested = Some(None);
        None
    }

    /// Requests the announcement of a focused button, after the first reading of the visit.
    pub fn announce_focus(&mut self, button: Option<Request>) {
        if self.announces_focus {
            self.requested = button.map(Some);
        }
    }

    /// Starts the requested reading with the texts of this picture, for an output with this sample rate, Hz.
    pub fn start_requested(&mut self, scene: &Scene, sample_rate: u32) {
        let (Some(requested), Some(synthesizer)) = (self.requested.take(), &self.synthesizer) else { return };
        let mut texts = match requested {
            None => speech_text::exhibit(scene),
            Some(button) => speech_text::button(button, scene),
        };
        texts.retain(|said| synthesizer.can_speak(&said.language));
        self.pending = Some(synthesizer.start(texts, sample_rate));
        self.announces_focus = true;
    }

    /// Ends the reading. Returns an empty sound that replaces the one being played, if there is one.
    pub fn stop(&mut self) -> Option<Utterance> {
        let on = self.is_on();
        (self.requested, self.pending, self.queued, self.playing) = (None, None, false, false);
        on.then(|| Utterance { samples: [].into(), sample_rate: 0 })
    }

    /// Ends the reading with the visit.
    pub fn end_visit(&mut self) -> Option<Utterance> {
        self.announces_focus = false;
        self.stop()
    }

    /// Advances the state once a picture. `playing`: does the output play speech now? Returns finished speech to play.
    pub fn update(&mut self, playing: bool) -> Option<Utterance> {
        // Silence before the output has started is not the end of the speech.
        self.queued &= !playing;
        self.playing = playing;
        let speech = self.pending.as_ref()?.poll()?;
        self.pending = None;
        match speech {
            Ok(speech) => {
                self.queued = !speech.samples.is_empty();
                Some(speech)
            }
            Err(error) => {
                tracing::warn!("nothing is read aloud: {error}");
                None
            }
        }
    }
}

/// Does the reading continue at this request? Only at requests that concern the reading.
pub fn keeps_reading(request: Option<Request>) -> bool {
    matches!(request, Some(Request::ReadAloud | Request::Louder(_) | Request::MoveFocus(_)))
}
