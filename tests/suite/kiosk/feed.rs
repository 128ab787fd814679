//! A recording in place of the microphone.

use soffio_offline::feed::WavFeed;

#[test]
fn a_recording_is_heard_whole_in_order_and_without_a_gap_at_any_rate() {
    for rate in [8_000, 11_025, 22_050, 44_100, 48_000, 192_000] {
        let samples: Vec<f32> = (0..rate).map(|i| i as f32).collect();
        let mut feed = WavFeed::new(samples.clone(), rate);
        let mut heard = Vec::new();
        for step in 0..240_u64 {
            assert!(!feed.is_over(), "{rate} Hz, step {step}");
            let part = feed.microphone().samples;
            assert_eq!(part.len() as u64, (step + 1) * u64::from(rate) / 240 - step * u64::from(rate) / 240);
            heard.extend_from_slice(part);
        }
        assert_eq!(heard, samples, "{rate} Hz");
        assert!(feed.is_over() && feed.microphone().samples.is_empty());
    }
}
