//! The live kiosk: window, visitor, attract mode, staff.
