//! MQTT client: reports the state of the kiosk to a broker, and takes commands from it. Off unless the site names a broker.
//!
//! ```text
//! TOPIC/status   "online"; "offline" as the last will when the connection is lost; retained
//! TOPIC/state    JSON: exhibit on show, devices, counters; retained, sent when it changes
//! TOPIC/cmd      commands to the kiosk, see [`Order`]; a retained one is ignored, as it would come again at every start
//! ```
//!
//! The client has a thread of its own and retries for ever with growing pauses. Nothing in the kiosk waits for it.

use std::str::FromStr;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use rumqttc::{Client, Connection, Event, Incoming, LastWill, MqttOptions, Outgoing, QoS};

use soffio_config::{MqttOrder, MqttSettings};

/// Least time between two state messages.
const EVERY: Duration = Duration::from_secs(1);
/// MQTT keep-alive. After one and a half of it without a message the broker sends the last will.
const KEEP_ALIVE: Duration = Duration::from_secs(5);
/// Shortest and longest pause between two tries to connect.
const PAUSES: [Duration; 2] = [Duration::from_secs(1), Duration::from_secs(60)];
/// Capacity of the client's queue, messages.
const QUEUE: usize = 16;
/// Longest wait at the end for the last message to be sent.
const FAREWELL: Duration = Duration::from_millis(300);

/// A command to the kiosk, parsed from the text of a message.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Order {
    /// `reload`: load the exhibit on show from its files again.
    Reload,
    /// `blank`: black screen, no sound, the microphone off.
    Blank,
    /// `wake`: end `blank`.
    Wake,
    /// `mute` or `mute on`; `mute off`.
    Mute(bool),
    /// `exhibit ID`: show another exhibit.
    Exhibit(String),
}

impl Order {
    /// Its kind, as the configuration allows it.
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
        let parts: Vec<&str> = text.split_whitespace().collect();
        Ok(match parts[..] {
            ["reload"] => Self::Reload,
            ["blank"] => Self::Blank,
            ["wake"] => Self::Wake,
            ["mute"] | ["mute", "on"] => Self::Mute(true),
            ["mute", "off"] => Self::Mute(false),
            ["exhibit", id] => Self::Exhibit(id.to_owned()),
            _ => return Err("send reload, blank, wake, mute on, mute off, or exhibit and an id".into()),
        })
    }
}

/// Connection to the broker.
pub struct Mqtt {
    link: Option<BrokerLink>,
    orders: Receiver<Order>,
    said: Option<Instant>,
}

struct BrokerLink {
    client: Client,
    shared: Arc<Shared>,
    thread: JoinHandle<()>,
    topic: String,
}

/// State shared by both threads.
#[derive(Default)]
struct Shared {
    online: AtomicBool,
    over: AtomicBool,
    /// The last state, for a later connection.
    state: Mutex<String>,
}

impl Shared {
    fn state(&self) -> String {
        self.state.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

impl Mqtt {
    /// Without a broker.
    pub fn none() -> Self {
        Self { link: None, orders: channel().1, said: None }
    }

    /// Connects to the site's broker; without one there is no connection and no thread.
    pub fn start(settings: &MqttSettings) -> Self {
        let (orders_sender, orders) = channel();
        let link = settings.address().map(|(host, port)| {
            let mut options = MqttOptions::new(settings.topic.replace('/', "-"), host, port);
            options.set_keep_alive(KEEP_ALIVE);
            options.set_last_will(LastWill::new(topic(settings, "status"), "offline", QoS::AtLeastOnce, true));
            if !settings.user.is_empty() {
                options.set_credentials(&settings.user, &settings.password);
            }
            let (client, connection) = Client::new(options, QUEUE);
            let shared = Arc::new(Shared::default());
            let thread = MqttThread {
                client: client.clone(),
                shared: shared.clone(),
                settings: settings.clone(),
                orders_sender,
            };
            let thread = std::thread::Builder::new().name("soffio-mqtt".into()).spawn(move || thread.run(connection));
            thread.map(|thread| BrokerLink { client, shared, thread, topic: settings.topic.clone() })
        });
        let link = link.transpose().unwrap_or_else(|error| {
            tracing::warn!("mqtt: {error}");
            None
        });
        Self { link, orders, said: None }
    }

    /// Publishes a changed state, once a second at most; `state` is called only then.
    pub fn update(&mut self, now: Instant, state: impl FnOnce() -> serde_json::Value) {
        let Some(link) = &self.link else { return };
        if self.said.is_some_and(|at| now.duration_since(at) < EVERY) {
            return;
        }
        self.said = Some(now);
        let state = state().to_string();
        if *link.shared.state.lock().unwrap_or_else(PoisonError::into_inner) == state {
            return;
        }
        // If the queue is full, the next state is sent instead.
        let sent = !link.shared.online.load(Ordering::Relaxed)
            || link.client.try_publish(format!("{}/state", link.topic), QoS::AtLeastOnce, true, state.clone()).is_ok();
        if sent {
            *link.shared.state.lock().unwrap_or_else(PoisonError::into_inner) = state;
        }
    }

    /// The next allowed command.
    pub fn order(&self) -> Option<Order> {
        self.orders.try_recv().ok()
    }
}

impl Drop for Mqtt {
    /// Publishes the orderly end; the last will is for crashes.
    fn drop(&mut self) {
        let Some(link) = self.link.take() else { return };
        link.shared.over.store(true, Ordering::Relaxed);
        if !link.shared.online.load(Ordering::Relaxed) {
            // The thread may sleep for a minute before its next try; it ends with the process.
            return;
        }
        let said = link.client.try_publish(format!("{}/status", link.topic), QoS::AtLeastOnce, true, "offline");
        if said.and_then(|()| link.client.try_disconnect()).is_ok() {
            let until = Instant::now() + FAREWELL;
            while !link.thread.is_finished() && Instant::now() < until {
                std::thread::sleep(Duration::from_millis(5));
            }
        }
    }
}

/// State of the client's thread.
struct MqttThread {
    client: Client,
    shared: Arc<Shared>,
    settings: MqttSettings,
    orders_sender: Sender<Order>,
}

impl MqttThread {
    fn run(self, mut connection: Connection) {
        let [mut pause, longest] = PAUSES;
        let mut lost = false;
        for event in connection.iter() {
            match event {
                Ok(Event::Incoming(Incoming::ConnAck(_))) => {
                    tracing::info!("mqtt: connected to {} as {}", self.settings.broker, self.settings.topic);
                    (pause, lost) = (PAUSES[0], false);
                    self.announce();
                }
                Ok(Event::Incoming(Incoming::Publish(message))) => {
                    self.handle_message(message.retain, &message.payload)
                }
                Ok(Event::Outgoing(Outgoing::Disconnect)) => return,
                Ok(_) => {}
                Err(error) => {
                    self.shared.online.store(false, Ordering::Relaxed);
                    // Logged once for all failed tries in a row.
                    if !lost {
                        tracing::warn!("mqtt: no connection to {}: {error}; retrying", self.settings.broker);
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

    /// Subscribes to commands, and publishes status and state to a new connection.
    fn announce(&self) {
        let (client, settings) = (&self.client, &self.settings);
        let publish =
            |what: &str, text: String| client.try_publish(topic(settings, what), QoS::AtLeastOnce, true, text);
        let announced = client
            .try_subscribe(topic(settings, "cmd"), QoS::AtLeastOnce)
            .and_then(|()| publish("status", "online".into()))
            .and_then(|()| publish("state", self.shared.state()));
        match announced {
            Ok(()) => self.shared.online.store(true, Ordering::Relaxed),
            Err(error) => tracing::warn!("mqtt: {error}"),
        }
    }

    fn handle_message(&self, retained: bool, payload: &[u8]) {
        // An empty message deletes a retained one, and is no command.
        if payload.is_empty() {
            return;
        }
        let text = String::from_utf8_lossy(payload);
        // Foreign text is logged short and on one line.
        let shown: String = text.chars().take(60).filter(|c| !c.is_control()).collect();
        if retained {
            return tracing::warn!("mqtt: the retained command \"{shown}\" is ignored: send it without retain");
        }
        match text.parse::<Order>() {
            Ok(order) if self.settings.obeys.contains(&order.kind()) => {
                tracing::info!("mqtt: command: {shown}");
                // A closed receiver is about to end.
                let _ = self.orders_sender.send(order);
            }
            Ok(_) => tracing::warn!("mqtt: \"{shown}\" is not among mqtt.obeys"),
            Err(help) => tracing::warn!("mqtt: \"{shown}\" is no command: {help}"),
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
        mqtt.update(Instant::now(), || unreachable!("nobody wants to know"));
        assert!(mqtt.link.is_none() && mqtt.order().is_none());
    }
}
