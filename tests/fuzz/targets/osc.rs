#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| soffio_fuzz::bounded(soffio_fuzz::messages::osc, bytes));
