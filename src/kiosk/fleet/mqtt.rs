//! MQTT client: reports the state of the kiosk to a broker, and takes commands from it. Off unless the site names a broker.
//!
//! ```text
//! TOPIC/status   "online"; "offline" as the last will when the connection is lost; retained
//! TOPIC/state    JSON: exhibit on show, devices, counters; retained, sent when it changes
//! TOPIC/cmd      commands to the kiosk, see [`Order`]; a retained one is ignored, as it would come again at every start
//! ```
//!
//! The client has a thread of its own and retries for ever with growing pauses. Nothing in the kiosk waits for it. Commands wait in
//! [`Orders`], where a later one replaces an earlier one of its kind: a burst of thousands costs no more than one.

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use rumqttc::{Client, Connection, Event, Incoming, LastWill, MqttOptions, Outgoing, QoS, TlsConfiguration, Transport};

use super::orders::{Order, Orders};
use soffio_config::MqttSettings;

/// Least time between two state messages.
const EVERY: Duration = Duration::from_secs(1);
/// MQTT keep-alive. After one and a half of it without a message the broker sends the last will.
const KEEP_ALIVE: Duration = Duration::from_secs(5);
/// Shortest and longest pause between two tries to connect.
const PAUSES: [Duration; 2] = [Duration::from_secs(1), Duration::from_secs(60)];
/// Capacity of the client's queue, messages.
const QUEUE: usize = 16;
/// Bytes of a command that are read; the longest one is the id of an exhibit.
const MOST_BYTES: usize = 300;
/// Longest wait at the end for the last message to be sent.
const FAREWELL: Duration = Duration::from_millis(300);

/// Connection to the broker.
pub struct Mqtt {
    link: Option<BrokerLink>,
    orders: Arc<Mutex<Orders>>,
    said: Option<Instant>,
}

struct BrokerLink {
    client: Client,
    shared: Arc<Shared>,
    thread: JoinHandle<()>,
    topic: String,
}

impl BrokerLink {
    /// Starts the thread; `None` without a broker. The error says which file or thread is missing.
    fn start(settings: &MqttSettings, instance: &str, orders: &Arc<Mutex<Orders>>) -> Result<Option<Self>, String> {
        let Some((host, port)) = settings.address() else { return Ok(None) };
        let mut options = MqttOptions::new(client_id(&machine(), instance), host, port);
        options.set_keep_alive(KEEP_ALIVE);
        options.set_last_will(LastWill::new(topic(settings, "status"), "offline", QoS::AtLeastOnce, true));
        if settings.is_encrypted() {
            options.set_transport(Transport::Tls(encryption(settings)?));
        }
        if !settings.user.is_empty() {
            options.set_credentials(&settings.user, &settings.password);
        }
        let (client, connection) = Client::new(options, QUEUE);
        let shared = Arc::new(Shared::default());
        let thread = MqttThread {
            client: client.clone(),
            shared: shared.clone(),
            settings: settings.clone(),
            orders: orders.clone(),
        };
        let thread = std::thread::Builder::new().name("soffio-mqtt".into()).spawn(move || thread.run(connection));
        let thread = thread.map_err(|error| error.to_string())?;
        Ok(Some(Self { client, shared, thread, topic: settings.topic.clone() }))
    }
}

/// The files of an encrypted connection.
fn encryption(settings: &MqttSettings) -> Result<TlsConfiguration, String> {
    let read = |key: &str, file: &Path| {
        std::fs::read(file)
            .map_err(|error| format!("no connection: mqtt.{key} = \"{}\" cannot be read: {error}", file.display()))
    };
    // Another part of the program may have chosen already: both use the same library.
    let _ = rustls::crypto::ring::default_provider().install_default();
    let own = || Ok::<_, String>((read("certificate", &settings.certificate)?, read("key", &settings.key)?));
    Ok(TlsConfiguration::Simple {
        ca: read("authority", &settings.authority)?,
        alpn: None,
        client_auth: settings.has_certificate().then(own).transpose()?,
    })
}

/// Id of the client, 23 characters as MQTT 3.1.1 allows (section 3.1.3.1). Two clients with one id would evict each other for ever, so it
/// depends on the machine and on the instance, and is the same after a restart.
fn client_id(machine: &str, instance: &str) -> String {
    format!("soffio-{:016x}", super::fnv1a([machine, "/", instance].iter().flat_map(|text| text.bytes())))
}

/// What distinguishes this machine from others: systemd's machine id, else the name of the host. Only a hash of it leaves the machine.
fn machine() -> String {
    let files = ["/etc/machine-id", "/var/lib/dbus/machine-id", "/proc/sys/kernel/hostname"];
    files
        .iter()
        .filter_map(|file| std::fs::read_to_string(file).ok())
        .find(|id| !id.trim().is_empty())
        .unwrap_or_default()
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
        Self { link: None, orders: Arc::default(), said: None }
    }

    /// Connects to the site's broker; without one there is no connection and no thread. `instance` distinguishes this kiosk from others
    /// on the same machine.
    pub fn start(settings: &MqttSettings, instance: &str) -> Self {
        let orders = Arc::<Mutex<Orders>>::default();
        let link = BrokerLink::start(settings, instance, &orders).unwrap_or_else(|error| {
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

    /// The next allowed command that is due.
    pub fn order(&self, now: Instant) -> Option<Order> {
        self.orders.lock().unwrap_or_else(PoisonError::into_inner).next(now)
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
    orders: Arc<Mutex<Orders>>,
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
        // Text from outside is logged short and on one line.
        let text = String::from_utf8_lossy(&payload[..payload.len().min(MOST_BYTES)]);
        let shown: String = text.chars().take(60).filter(|c| !c.is_control()).collect();
        let refused = match text.parse::<Order>() {
            _ if retained => format!("the retained command \"{shown}\" is ignored: send it without retain"),
            Ok(order) if self.settings.obeys.contains(&order.kind()) => {
                return self.orders.lock().unwrap_or_else(PoisonError::into_inner).push(order);
            }
            Ok(_) => format!("\"{shown}\" is not among mqtt.obeys"),
            Err(help) => format!("\"{shown}\" is no command: {help}"),
        };
        let orders = &mut self.orders.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(more) = orders.refuse(Instant::now()) {
            let before = if more > 0 { format!(" ({more} others before it)") } else { String::new() };
            tracing::warn!("mqtt: {refused}{before}");
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
    fn without_a_broker_there_is_no_line_and_nobody_is_asked_for_the_state() {
        let mut mqtt = Mqtt::start(&MqttSettings::default(), "");
        mqtt.update(Instant::now(), || unreachable!("nobody wants to know"));
        assert!(mqtt.link.is_none() && mqtt.order(Instant::now()).is_none());
    }
    #[test]
    fn each_kiosk_has_an_id_of_its_own_that_a_restart_keeps() {
        let ids = [client_id("m1", "/a"), client_id("m1", "/b"), client_id("m2", "/a"), client_id("m", "1//a")];
        assert!(ids.iter().all(|id| id.len() == 23 && id.is_ascii()), "{ids:?}");
        let distinct: std::collections::BTreeSet<_> = ids.iter().collect();
        assert!(distinct.len() == ids.len() && ids[0] == client_id("m1", "/a"), "{ids:?}");
    }

    #[test]
    fn a_file_that_is_missing_is_named_and_nothing_is_sent_unencrypted() {
        let settings = MqttSettings {
            broker: "127.0.0.1:1".into(),
            authority: "/nowhere/ca.pem".into(),
            ..MqttSettings::default()
        };
        let error = BrokerLink::start(&settings, "", &Arc::default()).err().unwrap_or_default();
        assert!(error.contains("mqtt.authority = \"/nowhere/ca.pem\""), "{error}");
    }
}
