//! One line to whoever looks after many kiosks: an MQTT broker in the house. Off unless the site names one.
//!
//! ```text
//! TOPIC/status   "online", and by the broker's own hand "offline" when the kiosk is gone; retained
//! TOPIC/state    JSON: what is on show, devices, counters; retained, when it changes
//! TOPIC/cmd      orders to the kiosk, see [`Order`]; a retained one is not obeyed, for it would come again at every start
//! ```
//!
//! The client has a thread of its own, tries for ever with growing pauses, and nothing in the kiosk waits for it.

use std::str::FromStr;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use rumqttc::{Client, Connection, Event, Incoming, LastWill, MqttOptions, Outgoing, QoS};

use soffio_config::{MqttOrder, MqttSettings};

/// Between two states, at least.
const EVERY: Duration = Duration::from_secs(1);
/// The broker takes the kiosk for gone when it has said nothing for one and a half of this.
const KEEP_ALIVE: Duration = Duration::from_secs(5);
/// Pauses between two tries to reach the broker.
const PAUSES: [Duration; 2] = [Duration::from_secs(1), Duration::from_secs(60)];
/// Messages that wait for the line.
const QUEUE: usize = 16;
/// How long an orderly end may take until the broker has heard of it.
const FAREWELL: Duration = Duration::from_millis(300);

/// What the kiosk is told to do, as the text of a message.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Order {
    /// `reload`: the work on show from its files again.
    Reload,
    /// `blank`: black, mute, the microphone closed.
    Blank,
    /// `wake`: an end of that.
    Wake,
    /// `mute` or `mute on`; `mute off`.
    Mute(bool),
    /// `exhibit ID`: another work.
    Exhibit(String),
}

impl Order {
    /// Which of the orders that a site may allow.
    pub fn kind(&self) -> MqttOrder {
        match self {
            Self::Reload => MqttOrder::Reload,
            Self::Blank => MqttOrder::Blank,
            Self::Wake => MqttOrder::Wake,
            Self::Mute(_) => MqttOrder::Mute,
            Self::Exhibit(_) => MqttOrder::Exhibit,
        }
    }
}

impl FromStr for Order {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let words: Vec<&str> = text.split_whitespace().collect();
        Ok(match words[..] {
            ["reload"] => Self::Reload,
            ["blank"] => Self::Blank,
            ["wake"] => Self::Wake,
            ["mute"] | ["mute", "on"] => Self::Mute(true),
            ["mute", "off"] => Self::Mute(false),
            ["exhibit", id] => Self::Exhibit(id.to_owned()),
            _ => return Err("say reload, blank, wake, mute on, mute off, or exhibit and an id".into()),
        })
    }
}

/// The line to the broker.
pub struct Mqtt {
    line: Option<Line>,
    orders: Receiver<Order>,
    said: Option<Instant>,
}

struct Line {
    client: Client,
    shared: Arc<Shared>,
    thread: JoinHandle<()>,
    topic: String,
}

/// What both threads know.
#[derive(Default)]
struct Shared {
    online: AtomicBool,
    over: AtomicBool,
    /// The last state, for a broker that comes later.
    state: Mutex<String>,
}

impl Shared {
    fn state(&self) -> String {
        self.state.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

impl Mqtt {
    /// To nobody.
    pub fn none() -> Self {
        Self { line: None, orders: channel().1, said: None }
    }

    /// To the broker that the site names; no line and no thread where it names none.
    pub fn start(settings: &MqttSettings) -> Self {
        let (tell, orders) = channel();
        let line = settings.address().map(|(host, port)| {
            let mut options = MqttOptions::new(settings.topic.replace('/', "-"), host, port);
            options.set_keep_alive(KEEP_ALIVE);
            options.set_last_will(LastWill::new(topic(settings, "status"), "offline", QoS::AtLeastOnce, true));
            if !settings.user.is_empty() {
                options.set_credentials(&settings.user, &settings.password);
            }
            let (client, connection) = Client::new(options, QUEUE);
            let shared = Arc::new(Shared::default());
            let thread = Thread { client: client.clone(), shared: shared.clone(), settings: settings.clone(), tell };
            let thread = std::thread::Builder::new().name("soffio-mqtt".into()).spawn(move || thread.run(connection));
            thread.map(|thread| Line { client, shared, thread, topic: settings.topic.clone() })
        });
        let line = line.transpose().unwrap_or_else(|error| {
            tracing::warn!("mqtt: {error}");
            None
        });
        Self { line, orders, said: None }
    }

    /// Tells the broker what is new, once a second at most; `state` is asked when it may be told.
    pub fn tend(&mut self, now: Instant, state: impl FnOnce() -> serde_json::Value) {
        let Some(line) = &self.line else { return };
        if self.said.is_some_and(|at| now.duration_since(at) < EVERY) {
            return;
        }
        self.said = Some(now);
        let state = state().to_string();
        if *line.shared.state.lock().unwrap_or_else(PoisonError::into_inner) == state {
            return;
        }
        // What does not fit into the line now is told with the next state.
        let told = !line.shared.online.load(Ordering::Relaxed)
            || line.client.try_publish(format!("{}/state", line.topic), QoS::AtLeastOnce, true, state.clone()).is_ok();
        if told {
            *line.shared.state.lock().unwrap_or_else(PoisonError::into_inner) = state;
        }
    }

    /// The next order that has come and is allowed.
    pub fn order(&self) -> Option<Order> {
        self.orders.try_recv().ok()
    }
}

impl Drop for Mqtt {
    /// Says that the kiosk goes, before it goes: the last will is for those that die.
    fn drop(&mut self) {
        let Some(line) = self.line.take() else { return };
        line.shared.over.store(true, Ordering::Relaxed);
        if !line.shared.online.load(Ordering::Relaxed) {
            // The thread may sleep for a minute before its next try; it ends with the process.
            return;
        }
        let said = line.client.try_publish(format!("{}/status", line.topic), QoS::AtLeastOnce, true, "offline");
        if said.and_then(|()| line.client.try_disconnect()).is_ok() {
            let until = Instant::now() + FAREWELL;
            while !line.thread.is_finished() && Instant::now() < until {
                std::thread::sleep(Duration::from_millis(5));
            }
        }
    }
}

/// What lives on the line's thread.
struct Thread {
    client: Client,
    shared: Arc<Shared>,
    settings: MqttSettings,
    tell: Sender<Order>,
}

impl Thread {
    fn run(self, mut connection: Connection) {
        let [mut pause, longest] = PAUSES;
        let mut lost = false;
        for event in connection.iter() {
            match event {
                Ok(Event::Incoming(Incoming::ConnAck(_))) => {
                    tracing::info!("mqtt: {} is told as {}", self.settings.broker, self.settings.topic);
                    (pause, lost) = (PAUSES[0], false);
                    self.greet();
                }
                Ok(Event::Incoming(Incoming::Publish(message))) => self.hear(message.retain, &message.payload),
                Ok(Event::Outgoing(Outgoing::Disconnect)) => return,
                Ok(_) => {}
                Err(error) => {
                    self.shared.online.store(false, Ordering::Relaxed);
                    // Once for all tries that fail alike.
                    if !lost {
                        tracing::warn!("mqtt: {} does not answer: {error}; it is tried again", self.settings.broker);
                    }
                    lost = true;
                    std::thread::sleep(pause);
                    pause = (2 * pause).min(longest);
                }
            }
            if self.shared.over.load(Ordering::Relaxed) && !self.shared.online.load(Ordering::Relaxed) {
                return;
            }
        }
    }

    /// The broker answers: it learns what it may have missed.
    fn greet(&self) {
        let (client, settings) = (&self.client, &self.settings);
        let publish =
            |what: &str, text: String| client.try_publish(topic(settings, what), QoS::AtLeastOnce, true, text);
        let greeted = client
            .try_subscribe(topic(settings, "cmd"), QoS::AtLeastOnce)
            .and_then(|()| publish("status", "online".into()))
            .and_then(|()| publish("state", self.shared.state()));
        match greeted {
            Ok(()) => self.shared.online.store(true, Ordering::Relaxed),
            Err(error) => tracing::warn!("mqtt: {error}"),
        }
    }

    fn hear(&self, retained: bool, payload: &[u8]) {
        // An empty message takes a retained one away: it is no order, and none was meant.
        if payload.is_empty() {
            return;
        }
        let text = String::from_utf8_lossy(payload);
        // What is logged of a stranger's message is short and on one line.
        let shown: String = text.chars().take(60).filter(|c| !c.is_control()).collect();
        if retained {
            return tracing::warn!("mqtt: the retained order \"{shown}\" is not obeyed: send it without retain");
        }
        match text.parse::<Order>() {
            Ok(order) if self.settings.obeys.contains(&order.kind()) => {
                tracing::info!("mqtt: ordered: {shown}");
                // Whoever does not listen any more is about to end.
                let _ = self.tell.send(order);
            }
            Ok(_) => tracing::warn!("mqtt: \"{shown}\" is not among mqtt.obeys"),
            Err(help) => tracing::warn!("mqtt: \"{shown}\" is no order: {help}"),
        }
    }
}

fn topic(settings: &MqttSettings, what: &str) -> String {
    format!("{}/{what}", settings.topic)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orders_are_words_and_nothing_else_is_obeyed() {
        for (text, order) in [
            ("reload", Order::Reload),
            (" blank\n", Order::Blank),
            ("wake", Order::Wake),
            ("mute", Order::Mute(true)),
            ("mute on", Order::Mute(true)),
            ("mute off", Order::Mute(false)),
            ("exhibit terry-clock", Order::Exhibit("terry-clock".into())),
        ] {
            assert_eq!(text.parse(), Ok(order), "{text}");
        }
        for text in ["", "Reload", "exhibit", "exhibit a b", "mute maybe", "reload now", "shutdown"] {
            assert!(text.parse::<Order>().is_err_and(|help| help.contains("exhibit and an id")), "{text}");
        }
    }

    #[test]
    fn without_a_broker_there_is_no_line_and_nobody_is_asked_for_the_state() {
        let mut mqtt = Mqtt::start(&MqttSettings::default());
        mqtt.tend(Instant::now(), || unreachable!("nobody wants to know"));
        assert!(mqtt.line.is_none() && mqtt.order().is_none());
    }
}
