//! The site's configuration: `kiosk-config/kiosk.toml`. Every key has a unit, a range and a default; the shipped
//! file is the default (a test compares).
