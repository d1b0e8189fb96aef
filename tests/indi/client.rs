//! A very small INDI client: it keeps the last value of every element and the last state of every property.

use std::collections::BTreeMap;
use std::io::{Read, Write};
use std::net::TcpStream;
use std::time::{Duration, Instant};

/// How long anything may take before the test fails.
const PATIENCE: Duration = Duration::from_secs(45);

pub(crate) struct Client {
    stream: TcpStream,
    unread: String,
    device: String,
    values: BTreeMap<(String, String), String>,
    states: BTreeMap<String, String>,
    log: Vec<String>,
}

impl Client {
    /// Connects to an indiserver and asks for everything.
    pub(crate) fn connect(port: u16) -> Client {
        let deadline = Instant::now() + PATIENCE;
        let stream = loop {
            match TcpStream::connect(("127.0.0.1", port)) {
                Ok(stream) => break stream,
                Err(error) if Instant::now() > deadline => panic!("indiserver does not listen on {port}: {error}"),
                Err(_) => std::thread::sleep(Duration::from_millis(50)),
            }
        };
        stream.set_read_timeout(Some(Duration::from_millis(100))).unwrap();
        let mut client = Client {
            stream,
            unread: String::new(),
            device: String::new(),
            values: BTreeMap::new(),
            states: BTreeMap::new(),
            log: Vec::new(),
        };
        client.send("<getProperties version=\"1.7\"/>\n");
        client.wait("the driver's CONNECTION", |client| client.states.contains_key("CONNECTION"));
        client
    }

    fn send(&mut self, text: &str) {
        self.stream.write_all(text.as_bytes()).unwrap();
    }

    /// Turns switches on.
    pub(crate) fn switch(&mut self, property: &str, element: &str) {
        let device = &self.device;
        self.send(&format!(
            "<newSwitchVector device=\"{device}\" name=\"{property}\"><oneSwitch name=\"{element}\">On</oneSwitch></newSwitchVector>\n"
        ));
    }

    pub(crate) fn texts(&mut self, property: &str, elements: &[(&str, &str)]) {
        self.many("Text", property, elements);
    }

    pub(crate) fn numbers(&mut self, property: &str, elements: &[(&str, f64)]) {
        let elements: Vec<_> = elements.iter().map(|(name, value)| (*name, value.to_string())).collect();
        let elements: Vec<_> = elements.iter().map(|(name, value)| (*name, value.as_str())).collect();
        self.many("Number", property, &elements);
    }

    /// Sends a property and marks it as not yet answered.
    fn many(&mut self, kind: &str, property: &str, elements: &[(&str, &str)]) {
        let device = &self.device;
        let inside: String =
            elements.iter().map(|(name, value)| format!("<one{kind} name=\"{name}\">{value}</one{kind}>")).collect();
        let text = format!("<new{kind}Vector device=\"{device}\" name=\"{property}\">{inside}</new{kind}Vector>\n");
        self.states.insert(property.to_owned(), "Unanswered".to_owned());
        self.send(&text);
    }

    /// What INDI says the element is.
    pub(crate) fn text(&self, property: &str, element: &str) -> Option<&str> {
        self.values.get(&(property.to_owned(), element.to_owned())).map(String::as_str)
    }

    /// What INDI says the number is.
    pub(crate) fn number(&self, property: &str, element: &str) -> f64 {
        self.text(property, element).and_then(|text| text.parse().ok()).unwrap_or(f64::NAN)
    }

    pub(crate) fn is_on(&self, property: &str, element: &str) -> bool {
        self.text(property, element) == Some("On")
    }

    pub(crate) fn state(&self, property: &str) -> &str {
        self.states.get(property).map_or("not defined", String::as_str)
    }

    /// Waits until something holds; fails with everything INDI said.
    pub(crate) fn wait(&mut self, what: &str, holds: impl Fn(&Client) -> bool) {
        let deadline = Instant::now() + PATIENCE;
        while !holds(self) {
            assert!(
                Instant::now() < deadline,
                "waited in vain for {what}\nstates: {:?}\nvalues: {:?}\nmessages: {:#?}",
                self.states,
                self.values,
                self.log
            );
            self.read();
        }
    }

    /// Reads for some time whatever comes.
    pub(crate) fn listen(&mut self, time: Duration) {
        let deadline = Instant::now() + time;
        while Instant::now() < deadline {
            self.read();
        }
    }

    fn read(&mut self) {
        let mut bytes = [0; 8192];
        match self.stream.read(&mut bytes) {
            Ok(0) => panic!("indiserver has closed the connection; it said: {:#?}", self.log),
            Ok(count) => self.unread.push_str(&String::from_utf8_lossy(&bytes[..count])),
            Err(_timeout) => {}
        }
        while let Some((element, rest)) = first_element(&self.unread) {
            let (element, rest) = (element.to_owned(), rest.to_owned());
            self.unread = rest;
            self.take(&element);
        }
    }

    fn take(&mut self, element: &str) {
        let Some(head) = element.split('>').next() else { return };
        if let Some(message) = attribute(head, "message") {
            self.log.push(message.to_owned());
        }
        let is_vector = head.starts_with("<def") || head.starts_with("<set");
        let Some(property) = attribute(head, "name").filter(|_| is_vector) else { return };
        if property == "CONNECTION" {
            self.device = attribute(head, "device").unwrap_or_default().to_owned();
        }
        if let Some(state) = attribute(head, "state") {
            self.states.insert(property.to_owned(), state.to_owned());
        }
        for child in element[head.len()..].split('<').skip(1) {
            let Some((tag, value)) = child.split_once('>') else { continue };
            if let Some(name) = attribute(tag, "name") {
                self.values.insert((property.to_owned(), name.to_owned()), value.trim().to_owned());
            }
        }
    }
}

/// The first complete element of a stream of XML, and what follows it.
fn first_element(text: &str) -> Option<(&str, &str)> {
    let start = text.find('<')?;
    let text = &text[start..];
    let head_end = text.find('>')?;
    if text[..head_end].ends_with('/') {
        return Some(text.split_at(head_end + 1));
    }
    let name: String = text[1..].chars().take_while(|c| c.is_alphanumeric()).collect();
    let close = format!("</{name}>");
    let end = text.find(&close)? + close.len();
    Some(text.split_at(end))
}

/// The value of an attribute.
fn attribute<'a>(head: &'a str, name: &str) -> Option<&'a str> {
    let at = head.find(&format!(" {name}=\""))? + name.len() + 3;
    head[at..].split('"').next()
}
