//! Trained weights of the network of two capsules. Written by `soffio-training train`, not by hand.
//!
//! The weights of the high band were added as zeros to the previous table. Five training runs followed, each from the mean of
//! others, with 12 to 18 scenarios each. Two runs of 14 scenarios continued from the mean of the last three. They included breaths
//! during companions' talk, and the second one also breaths that rise above the noise only above 4 kHz. A third, like the second,
//! continued from the mean of both (`--resume --keep 0 --size 0.1`). Each weight is the mean of these three (Wortsman et al.,
//! "Model soups", ICML 2022).
//!
//! Before a new table replaces this one, score it (`soffio-training score --table`), and compare false positives and missed
//! breaths of both over the same day (`soffio-training day --table`).

use std::borrow::Cow;

use super::dual_mic_model::DualMicModel;

/// Trained weights.
#[rustfmt::skip]
#[allow(clippy::approx_constant)] // trained values may resemble constants by chance
pub static TRAINED: DualMicModel = DualMicModel {
    scale: [
        [-0.3178, 0.6010], // sum: log-odds, 10
        [1.0107, 1.1446], // sum: rise of 31–94 Hz over the noise floor, 10 dB
        [1.0816, 1.0996], // sum: rise of 94–203 Hz
        [0.9965, 1.0365], // sum: rise of 203–406 Hz
        [1.0070, 0.9532], // sum: rise of 406–812 Hz
        [0.9128, 0.9138], // sum: rise of 812–1625 Hz
        [0.7121, 0.8248], // sum: rise of 1625–3400 Hz
        [0.1542, 1.1381], // sum: rise of low less twice its floor variance, 10 dB
        [-0.0509, 0.9389], // sum: rise of middle less twice its floor variance, 10 dB
        [-0.8799, 1.0840], // sum: excess of 31–94 Hz over 94–203 Hz, 10 dB
        [-0.3017, 1.0706], // sum: excess of 94–203 Hz over 203–406 Hz
        [0.0750, 0.7769], // sum: excess of 203–406 Hz over 406–812 Hz
        [0.3773, 0.7371], // sum: excess of 406–812 Hz over 812–1625 Hz
        [0.5575, 0.8027], // sum: excess of 812–1625 Hz over 1625–3400 Hz
        [-1.0202, 0.9531], // sum: share of low in the excess, 10 dB
        [0.3570, 0.2271], // sum: periodicity of the excess, 80–400 Hz
        [0.3705, 0.1968], // sum: periodicity over 80 ms
        [-0.3867, 0.5289], // sum: flatness of the excess of low over 80 ms, 10 dB
        [-0.7024, 0.7346], // sum: flatness of the excess of 406–1625 Hz over 80 ms, 10 dB
        [0.0992, 0.8281], // sum: climb of low in 48 ms, 10 dB
        [0.3144, 1.2057], // sum: climb of low in 0.2 s
        [0.0907, 0.6872], // sum: climb of middle in 48 ms
        [0.2886, 1.0428], // sum: climb of middle in 0.2 s
        [0.5796, 0.7004], // sum: fall of low from its peak in 0.24 s, 10 dB
        [0.4509, 0.5946], // sum: fall of middle from its peak in 0.24 s
        [0.4057, 0.3878], // sum: deviation of low in 0.16 s, 10 dB
        [0.3272, 0.3439], // sum: deviation of middle in 0.16 s
        [0.4715, 0.4547], // sum: correlation of low and middle in 0.24 s
        [1.7158, 1.1639], // sum: time since nothing rose, logarithmic
        [-1.0366, 0.7966], // sum: share of low over 0.16 s, 10 dB
        [0.2446, 0.1033], // sum: change of the middle's shape from frame to frame, 10 dB
        [0.3999, 0.5861], // sum: steepest step of low in 0.1 s, 10 dB
        [0.2688, 0.4771], // sum: steepest step of middle in 0.1 s
        [0.2782, 0.1496], // sum: activity of low in the last 4 s
        [0.3282, 0.1923], // sum: activity of middle in the last 4 s
        [-0.5742, 1.1400], // sum: ratio of low to its own peak, 10 dB
        [-0.4578, 1.0226], // sum: ratio of middle to its own peak
        [0.4350, 0.1872], // sum: highest periodicity of the last second
        [0.4881, 0.4200], // sum: spectral correlation of low with 48 ms ago
        [-0.0703, 0.1132], // sum: kurtosis of the treble over 40 ms
        [-0.0714, 0.0848], // sum: kurtosis of the treble over 0.16 s
        [0.9264, 1.0203], // sum: rise of 31–94 Hz over the noise floor, 10 dB, mean of 0.1 s
        [0.9756, 0.9828], // sum: rise of 94–203 Hz, mean of 0.1 s
        [0.9068, 0.9125], // sum: rise of 203–406 Hz, mean of 0.1 s
        [0.9064, 0.8350], // sum: rise of 406–812 Hz, mean of 0.1 s
        [0.8286, 0.7853], // sum: rise of 812–1625 Hz, mean of 0.1 s
        [0.6504, 0.6977], // sum: rise of 1625–3400 Hz, mean of 0.1 s
        [0.0642, 1.0069], // sum: rise of low less twice its floor variance, 10 dB, mean of 0.1 s
        [-0.1317, 0.8167], // sum: rise of middle less twice its floor variance, 10 dB, mean of 0.1 s
        [-0.8471, 0.8526], // sum: excess of 31–94 Hz over 94–203 Hz, 10 dB, mean of 0.1 s
        [-0.3410, 0.8933], // sum: excess of 94–203 Hz over 203–406 Hz, mean of 0.1 s
        [0.0857, 0.6011], // sum: excess of 203–406 Hz over 406–812 Hz, mean of 0.1 s
        [0.3522, 0.5954], // sum: excess of 406–812 Hz over 812–1625 Hz, mean of 0.1 s
        [0.5289, 0.6710], // sum: excess of 812–1625 Hz over 1625–3400 Hz, mean of 0.1 s
        [-1.0324, 0.8282], // sum: share of low in the excess, 10 dB, mean of 0.1 s
        [0.3730, 0.1946], // sum: periodicity of the excess, 80–400 Hz, mean of 0.1 s
        [0.3824, 0.1939], // sum: periodicity over 80 ms, mean of 0.1 s
        [-0.3929, 0.4992], // sum: flatness of the excess of low over 80 ms, 10 dB, mean of 0.1 s
        [-0.7052, 0.6981], // sum: flatness of the excess of 406–1625 Hz over 80 ms, 10 dB, mean of 0.1 s
        [0.0800, 0.2820], // sum: climb of low in 48 ms, 10 dB, mean of 0.1 s
        [0.2408, 0.7403], // sum: climb of low in 0.2 s, mean of 0.1 s
        [0.0736, 0.2472], // sum: climb of middle in 48 ms, mean of 0.1 s
        [0.2136, 0.6566], // sum: climb of middle in 0.2 s, mean of 0.1 s
        [0.5871, 0.5075], // sum: fall of low from its peak in 0.24 s, 10 dB, mean of 0.1 s
        [0.4628, 0.4572], // sum: fall of middle from its peak in 0.24 s, mean of 0.1 s
        [0.3806, 0.2896], // sum: deviation of low in 0.16 s, 10 dB, mean of 0.1 s
        [0.3056, 0.2505], // sum: deviation of middle in 0.16 s, mean of 0.1 s
        [0.4475, 0.3777], // sum: correlation of low and middle in 0.24 s, mean of 0.1 s
        [1.5130, 1.1672], // sum: time since nothing rose, logarithmic, mean of 0.1 s
        [-1.0434, 0.7681], // sum: share of low over 0.16 s, 10 dB, mean of 0.1 s
        [0.2462, 0.0911], // sum: change of the middle's shape from frame to frame, 10 dB, mean of 0.1 s
        [0.3697, 0.4098], // sum: steepest step of low in 0.1 s, 10 dB, mean of 0.1 s
        [0.2417, 0.3138], // sum: steepest step of middle in 0.1 s, mean of 0.1 s
        [0.2705, 0.1501], // sum: activity of low in the last 4 s, mean of 0.1 s
        [0.3211, 0.1940], // sum: activity of middle in the last 4 s, mean of 0.1 s
        [-0.6846, 0.9844], // sum: ratio of low to its own peak, 10 dB, mean of 0.1 s
        [-0.5633, 0.9120], // sum: ratio of middle to its own peak, mean of 0.1 s
        [0.4445, 0.1858], // sum: highest periodicity of the last second, mean of 0.1 s
        [0.4802, 0.2796], // sum: spectral correlation of low with 48 ms ago, mean of 0.1 s
        [-0.0711, 0.0885], // sum: kurtosis of the treble over 40 ms, mean of 0.1 s
        [-0.0724, 0.0767], // sum: kurtosis of the treble over 0.16 s, mean of 0.1 s
        [0.7388, 0.8110], // sum: rise of 31–94 Hz over the noise floor, 10 dB, mean of 0.5 s
        [0.7745, 0.7802], // sum: rise of 94–203 Hz, mean of 0.5 s
        [0.7343, 0.7139], // sum: rise of 203–406 Hz, mean of 0.5 s
        [0.7331, 0.6510], // sum: rise of 406–812 Hz, mean of 0.5 s
        [0.6796, 0.6045], // sum: rise of 812–1625 Hz, mean of 0.5 s
        [0.5330, 0.5277], // sum: rise of 1625–3400 Hz, mean of 0.5 s
        [-0.0920, 0.7761], // sum: rise of low less twice its floor variance, 10 dB, mean of 0.5 s
        [-0.2554, 0.6293], // sum: rise of middle less twice its floor variance, 10 dB, mean of 0.5 s
        [-0.8365, 0.7341], // sum: excess of 31–94 Hz over 94–203 Hz, 10 dB, mean of 0.5 s
        [-0.3982, 0.7440], // sum: excess of 94–203 Hz over 203–406 Hz, mean of 0.5 s
        [0.0817, 0.4502], // sum: excess of 203–406 Hz over 406–812 Hz, mean of 0.5 s
        [0.3268, 0.4678], // sum: excess of 406–812 Hz over 812–1625 Hz, mean of 0.5 s
        [0.5002, 0.5391], // sum: excess of 812–1625 Hz over 1625–3400 Hz, mean of 0.5 s
        [-1.0543, 0.6984], // sum: share of low in the excess, 10 dB, mean of 0.5 s
        [0.3972, 0.1744], // sum: periodicity of the excess, 80–400 Hz, mean of 0.5 s
        [0.4020, 0.1755], // sum: periodicity over 80 ms, mean of 0.5 s
        [-0.4129, 0.4396], // sum: flatness of the excess of low over 80 ms, 10 dB, mean of 0.5 s
        [-0.7289, 0.6192], // sum: flatness of the excess of 406–1625 Hz over 80 ms, 10 dB, mean of 0.5 s
        [0.0469, 0.0850], // sum: climb of low in 48 ms, 10 dB, mean of 0.5 s
        [0.1587, 0.2878], // sum: climb of low in 0.2 s, mean of 0.5 s
        [0.0413, 0.0755], // sum: climb of middle in 48 ms, mean of 0.5 s
        [0.1364, 0.2582], // sum: climb of middle in 0.2 s, mean of 0.5 s
        [0.5696, 0.3812], // sum: fall of low from its peak in 0.24 s, 10 dB, mean of 0.5 s
        [0.4461, 0.3336], // sum: fall of middle from its peak in 0.24 s, mean of 0.5 s
        [0.3401, 0.2031], // sum: deviation of low in 0.16 s, 10 dB, mean of 0.5 s
        [0.2681, 0.1700], // sum: deviation of middle in 0.16 s, mean of 0.5 s
        [0.3856, 0.2822], // sum: correlation of low and middle in 0.24 s, mean of 0.5 s
        [1.2431, 0.9829], // sum: time since nothing rose, logarithmic, mean of 0.5 s
        [-1.0606, 0.6765], // sum: share of low over 0.16 s, 10 dB, mean of 0.5 s
        [0.2443, 0.0794], // sum: change of the middle's shape from frame to frame, 10 dB, mean of 0.5 s
        [0.3243, 0.2975], // sum: steepest step of low in 0.1 s, 10 dB, mean of 0.5 s
        [0.2029, 0.2116], // sum: steepest step of middle in 0.1 s, mean of 0.5 s
        [0.2500, 0.1474], // sum: activity of low in the last 4 s, mean of 0.5 s
        [0.3029, 0.1967], // sum: activity of middle in the last 4 s, mean of 0.5 s
        [-0.8652, 0.9064], // sum: ratio of low to its own peak, 10 dB, mean of 0.5 s
        [-0.7313, 0.8539], // sum: ratio of middle to its own peak, mean of 0.5 s
        [0.4628, 0.1660], // sum: highest periodicity of the last second, mean of 0.5 s
        [0.4811, 0.2424], // sum: spectral correlation of low with 48 ms ago, mean of 0.5 s
        [-0.0744, 0.0647], // sum: kurtosis of the treble over 40 ms, mean of 0.5 s
        [-0.0754, 0.0619], // sum: kurtosis of the treble over 0.16 s, mean of 0.5 s
        [-0.1772, 0.4975], // difference: log-odds, 10
        [0.9067, 1.3333], // difference: rise of 31–94 Hz over the noise floor, 10 dB
        [0.9792, 1.2971], // difference: rise of 94–203 Hz
        [0.8442, 1.0314], // difference: rise of 203–406 Hz
        [1.0007, 0.9504], // difference: rise of 406–812 Hz
        [0.9084, 0.9139], // difference: rise of 812–1625 Hz
        [0.7088, 0.8245], // difference: rise of 1625–3400 Hz
        [0.2987, 1.2226], // difference: rise of low less twice its floor variance, 10 dB
        [-0.0718, 0.9527], // difference: rise of middle less twice its floor variance, 10 dB
        [-0.5977, 0.7907], // difference: excess of 31–94 Hz over 94–203 Hz, 10 dB
        [-0.4356, 1.1079], // difference: excess of 94–203 Hz over 203–406 Hz
        [-1.5653, 1.7027], // difference: excess of 203–406 Hz over 406–812 Hz
        [0.3770, 0.7362], // difference: excess of 406–812 Hz over 812–1625 Hz
        [0.5566, 0.8023], // difference: excess of 812–1625 Hz over 1625–3400 Hz
        [-2.5422, 1.9266], // difference: share of low in the excess, 10 dB
        [0.3688, 0.2244], // difference: periodicity of the excess, 80–400 Hz
        [0.3838, 0.2005], // difference: periodicity over 80 ms
        [-0.3531, 0.4229], // difference: flatness of the excess of low over 80 ms, 10 dB
        [-0.7055, 0.7427], // difference: flatness of the excess of 406–1625 Hz over 80 ms, 10 dB
        [0.0640, 0.6128], // difference: climb of low in 48 ms, 10 dB
        [0.2205, 1.0191], // difference: climb of low in 0.2 s
        [0.0907, 0.6872], // difference: climb of middle in 48 ms
        [0.2886, 1.0428], // difference: climb of middle in 0.2 s
        [0.4439, 0.5372], // difference: fall of low from its peak in 0.24 s, 10 dB
        [0.4509, 0.5946], // difference: fall of middle from its peak in 0.24 s
        [0.2824, 0.3273], // difference: deviation of low in 0.16 s, 10 dB
        [0.3272, 0.3439], // difference: deviation of middle in 0.16 s
        [0.4248, 0.4294], // difference: correlation of low and middle in 0.24 s
        [1.8670, 1.2303], // difference: time since nothing rose, logarithmic
        [-2.4711, 1.7330], // difference: share of low over 0.16 s, 10 dB
        [0.2438, 0.1028], // difference: change of the middle's shape from frame to frame, 10 dB
        [0.2540, 0.3437], // difference: steepest step of low in 0.1 s, 10 dB
        [0.2688, 0.4771], // difference: steepest step of middle in 0.1 s
        [0.1854, 0.1809], // difference: activity of low in the last 4 s
        [0.3278, 0.1922], // difference: activity of middle in the last 4 s
        [-0.5044, 1.1766], // difference: ratio of low to its own peak, 10 dB
        [-0.4578, 1.0226], // difference: ratio of middle to its own peak
        [0.4496, 0.1946], // difference: highest periodicity of the last second
        [0.4873, 0.4184], // difference: spectral correlation of low with 48 ms ago
        [-0.0703, 0.1132], // difference: kurtosis of the treble over 40 ms
        [-0.0714, 0.0848], // difference: kurtosis of the treble over 0.16 s
        [0.8555, 1.2494], // difference: rise of 31–94 Hz over the noise floor, 10 dB, mean of 0.1 s
        [0.9173, 1.2135], // difference: rise of 94–203 Hz, mean of 0.1 s
        [0.7902, 0.9338], // difference: rise of 203–406 Hz, mean of 0.1 s
        [0.9003, 0.8329], // difference: rise of 406–812 Hz, mean of 0.1 s
        [0.8243, 0.7864], // difference: rise of 812–1625 Hz, mean of 0.1 s
        [0.6472, 0.6982], // difference: rise of 1625–3400 Hz, mean of 0.1 s
        [0.2515, 1.1277], // difference: rise of low less twice its floor variance, 10 dB, mean of 0.1 s
        [-0.1524, 0.8318], // difference: rise of middle less twice its floor variance, 10 dB, mean of 0.1 s
        [-0.5673, 0.6026], // difference: excess of 31–94 Hz over 94–203 Hz, 10 dB, mean of 0.1 s
        [-0.4457, 0.9595], // difference: excess of 94–203 Hz over 203–406 Hz, mean of 0.1 s
        [-1.5155, 1.5283], // difference: excess of 203–406 Hz over 406–812 Hz, mean of 0.1 s
        [0.3520, 0.5948], // difference: excess of 406–812 Hz over 812–1625 Hz, mean of 0.1 s
        [0.5283, 0.6708], // difference: excess of 812–1625 Hz over 1625–3400 Hz, mean of 0.1 s
        [-2.4842, 1.7769], // difference: share of low in the excess, 10 dB, mean of 0.1 s
        [0.3867, 0.1988], // difference: periodicity of the excess, 80–400 Hz, mean of 0.1 s
        [0.3977, 0.2000], // difference: periodicity over 80 ms, mean of 0.1 s
        [-0.3537, 0.3926], // difference: flatness of the excess of low over 80 ms, 10 dB, mean of 0.1 s
        [-0.7081, 0.7053], // difference: flatness of the excess of 406–1625 Hz over 80 ms, 10 dB, mean of 0.1 s
        [0.0566, 0.2409], // difference: climb of low in 48 ms, 10 dB, mean of 0.1 s
        [0.1823, 0.6824], // difference: climb of low in 0.2 s, mean of 0.1 s
        [0.0736, 0.2472], // difference: climb of middle in 48 ms, mean of 0.1 s
        [0.2136, 0.6566], // difference: climb of middle in 0.2 s, mean of 0.1 s
        [0.4342, 0.4091], // difference: fall of low from its peak in 0.24 s, 10 dB, mean of 0.1 s
        [0.4628, 0.4572], // difference: fall of middle from its peak in 0.24 s, mean of 0.1 s
        [0.2646, 0.2433], // difference: deviation of low in 0.16 s, 10 dB, mean of 0.1 s
        [0.3056, 0.2505], // difference: deviation of middle in 0.16 s, mean of 0.1 s
        [0.3997, 0.3583], // difference: correlation of low and middle in 0.24 s, mean of 0.1 s
        [1.6752, 1.2466], // difference: time since nothing rose, logarithmic, mean of 0.1 s
        [-2.4460, 1.6858], // difference: share of low over 0.16 s, 10 dB, mean of 0.1 s
        [0.2454, 0.0910], // difference: change of the middle's shape from frame to frame, 10 dB, mean of 0.1 s
        [0.2356, 0.2306], // difference: steepest step of low in 0.1 s, 10 dB, mean of 0.1 s
        [0.2417, 0.3138], // difference: steepest step of middle in 0.1 s, mean of 0.1 s
        [0.1792, 0.1784], // difference: activity of low in the last 4 s, mean of 0.1 s
        [0.3207, 0.1939], // difference: activity of middle in the last 4 s, mean of 0.1 s
        [-0.5607, 1.0634], // difference: ratio of low to its own peak, 10 dB, mean of 0.1 s
        [-0.5633, 0.9120], // difference: ratio of middle to its own peak, mean of 0.1 s
        [0.4609, 0.1947], // difference: highest periodicity of the last second, mean of 0.1 s
        [0.4695, 0.2863], // difference: spectral correlation of low with 48 ms ago, mean of 0.1 s
        [-0.0711, 0.0885], // difference: kurtosis of the treble over 40 ms, mean of 0.1 s
        [-0.0724, 0.0767], // difference: kurtosis of the treble over 0.16 s, mean of 0.1 s
        [0.7188, 1.0559], // difference: rise of 31–94 Hz over the noise floor, 10 dB, mean of 0.5 s
        [0.7638, 1.0222], // difference: rise of 94–203 Hz, mean of 0.5 s
        [0.6581, 0.7632], // difference: rise of 203–406 Hz, mean of 0.5 s
        [0.7276, 0.6497], // difference: rise of 406–812 Hz, mean of 0.5 s
        [0.6758, 0.6065], // difference: rise of 812–1625 Hz, mean of 0.5 s
        [0.5303, 0.5289], // difference: rise of 1625–3400 Hz, mean of 0.5 s
        [0.1457, 0.9241], // difference: rise of low less twice its floor variance, 10 dB, mean of 0.5 s
        [-0.2752, 0.6465], // difference: rise of middle less twice its floor variance, 10 dB, mean of 0.5 s
        [-0.5217, 0.5163], // difference: excess of 31–94 Hz over 94–203 Hz, 10 dB, mean of 0.5 s
        [-0.4704, 0.8446], // difference: excess of 94–203 Hz over 203–406 Hz, mean of 0.5 s
        [-1.5044, 1.2922], // difference: excess of 203–406 Hz over 406–812 Hz, mean of 0.5 s
        [0.3267, 0.4671], // difference: excess of 406–812 Hz over 812–1625 Hz, mean of 0.5 s
        [0.4999, 0.5390], // difference: excess of 812–1625 Hz over 1625–3400 Hz, mean of 0.5 s
        [-2.4471, 1.5511], // difference: share of low in the excess, 10 dB, mean of 0.5 s
        [0.4167, 0.1814], // difference: periodicity of the excess, 80–400 Hz, mean of 0.5 s
        [0.4227, 0.1833], // difference: periodicity over 80 ms, mean of 0.5 s
        [-0.3623, 0.3479], // difference: flatness of the excess of low over 80 ms, 10 dB, mean of 0.5 s
        [-0.7308, 0.6245], // difference: flatness of the excess of 406–1625 Hz over 80 ms, 10 dB, mean of 0.5 s
        [0.0385, 0.0842], // difference: climb of low in 48 ms, 10 dB, mean of 0.5 s
        [0.1378, 0.2977], // difference: climb of low in 0.2 s, mean of 0.5 s
        [0.0413, 0.0755], // difference: climb of middle in 48 ms, mean of 0.5 s
        [0.1364, 0.2582], // difference: climb of middle in 0.2 s, mean of 0.5 s
        [0.4030, 0.3075], // difference: fall of low from its peak in 0.24 s, 10 dB, mean of 0.5 s
        [0.4461, 0.3336], // difference: fall of middle from its peak in 0.24 s, mean of 0.5 s
        [0.2328, 0.1707], // difference: deviation of low in 0.16 s, 10 dB, mean of 0.5 s
        [0.2681, 0.1700], // difference: deviation of middle in 0.16 s, mean of 0.5 s
        [0.3373, 0.2635], // difference: correlation of low and middle in 0.24 s, mean of 0.5 s
        [1.3798, 1.0814], // difference: time since nothing rose, logarithmic, mean of 0.5 s
        [-2.4371, 1.5109], // difference: share of low over 0.16 s, 10 dB, mean of 0.5 s
        [0.2435, 0.0800], // difference: change of the middle's shape from frame to frame, 10 dB, mean of 0.5 s
        [0.2013, 0.1586], // difference: steepest step of low in 0.1 s, 10 dB, mean of 0.5 s
        [0.2029, 0.2116], // difference: steepest step of middle in 0.1 s, mean of 0.5 s
        [0.1608, 0.1680], // difference: activity of low in the last 4 s, mean of 0.5 s
        [0.3026, 0.1967], // difference: activity of middle in the last 4 s, mean of 0.5 s
        [-0.6661, 0.9669], // difference: ratio of low to its own peak, 10 dB, mean of 0.5 s
        [-0.7313, 0.8539], // difference: ratio of middle to its own peak, mean of 0.5 s
        [0.4846, 0.1752], // difference: highest periodicity of the last second, mean of 0.5 s
        [0.4486, 0.2570], // difference: spectral correlation of low with 48 ms ago, mean of 0.5 s
        [-0.0744, 0.0647], // difference: kurtosis of the treble over 40 ms, mean of 0.5 s
        [-0.0754, 0.0619], // difference: kurtosis of the treble over 0.16 s, mean of 0.5 s
        [-1.5771, 1.2564], // difference ratio, 10 dB
        [0.2511, 0.4048], // sustained time of the difference
        [-1.4517, 1.0216], // decorrelation of 0.4 to 0.9 kHz, 10 dB
        [-1.2008, 0.8864], // decorrelation of 0.9 to 2 kHz
        [-0.9350, 0.8595], // decorrelation of 2 to 3.3 kHz
        [0.6723, 1.4149], // coherent rise of 0.4 to 0.9 kHz, 10 dB
        [0.6672, 1.4159], // coherent rise of 0.9 to 2 kHz
        [0.6400, 1.2911], // coherent rise of 2 to 3.3 kHz
        [0.6253, 0.8887], // high band: rise of 5.6–7 kHz over the noise floor, 10 dB
        [0.6714, 0.9239], // high band: rise of 4.4–5.6 kHz
        [0.4132, 0.9168], // high band: rise of the quietest third of 4.4–7 kHz
        [-0.0313, 0.9376], // high band: rise of all of it less twice its floor variance
        [0.0410, 0.5278], // high band: climb in 48 ms, 10 dB
        [0.1666, 0.8905], // high band: climb in 0.2 s
        [0.3841, 0.5729], // high band: fall from its peak in 0.24 s, 10 dB
        [0.2362, 0.2975], // high band: deviation in 0.16 s, 10 dB
        [0.1550, 0.3605], // high band: steepest step in 0.1 s, 10 dB
        [0.1706, 0.1427], // high band: activity in the last 4 s
        [-0.4460, 1.0562], // high band: ratio to its own peak, 10 dB
        [-0.8129, 0.8851], // high band: decorrelation of 5.6–7 kHz, 10 dB
        [-0.8537, 0.8930], // high band: decorrelation of 4.4–5.6 kHz
        [0.5806, 1.3899], // high band: coherent rise of 5.6–7 kHz, 10 dB
        [0.5986, 1.4394], // high band: coherent rise of 4.4–5.6 kHz
        [1.1352, 1.4419], // high band: excess of 0.4–3.4 kHz over it, 10 dB
        [0.5854, 0.7928], // high band: rise of 5.6–7 kHz over the noise floor, 10 dB, mean of 0.1 s
        [0.6281, 0.8275], // high band: rise of 4.4–5.6 kHz, mean of 0.1 s
        [0.3730, 0.8281], // high band: rise of the quietest third of 4.4–7 kHz, mean of 0.1 s
        [-0.0584, 0.8413], // high band: rise of all of it less twice its floor variance, mean of 0.1 s
        [0.0406, 0.2082], // high band: climb in 48 ms, 10 dB, mean of 0.1 s
        [0.1447, 0.5736], // high band: climb in 0.2 s, mean of 0.1 s
        [0.3690, 0.4474], // high band: fall from its peak in 0.24 s, 10 dB, mean of 0.1 s
        [0.2213, 0.2297], // high band: deviation in 0.16 s, 10 dB, mean of 0.1 s
        [0.1451, 0.2458], // high band: steepest step in 0.1 s, 10 dB, mean of 0.1 s
        [0.1648, 0.1412], // high band: activity in the last 4 s, mean of 0.1 s
        [-0.4786, 0.9383], // high band: ratio to its own peak, 10 dB, mean of 0.1 s
        [-0.7677, 0.8166], // high band: decorrelation of 5.6–7 kHz, 10 dB, mean of 0.1 s
        [-0.8081, 0.8223], // high band: decorrelation of 4.4–5.6 kHz, mean of 0.1 s
        [0.5263, 1.3192], // high band: coherent rise of 5.6–7 kHz, 10 dB, mean of 0.1 s
        [0.5415, 1.3682], // high band: coherent rise of 4.4–5.6 kHz, mean of 0.1 s
        [1.0969, 1.2745], // high band: excess of 0.4–3.4 kHz over it, 10 dB, mean of 0.1 s
        [0.4810, 0.6200], // high band: rise of 5.6–7 kHz over the noise floor, 10 dB, mean of 0.5 s
        [0.5146, 0.6493], // high band: rise of 4.4–5.6 kHz, mean of 0.5 s
        [0.2667, 0.6598], // high band: rise of the quietest third of 4.4–7 kHz, mean of 0.5 s
        [-0.1211, 0.6688], // high band: rise of all of it less twice its floor variance, mean of 0.5 s
        [0.0291, 0.0678], // high band: climb in 48 ms, 10 dB, mean of 0.5 s
        [0.1067, 0.2333], // high band: climb in 0.2 s, mean of 0.5 s
        [0.3341, 0.3325], // high band: fall from its peak in 0.24 s, 10 dB, mean of 0.5 s
        [0.1900, 0.1590], // high band: deviation in 0.16 s, 10 dB, mean of 0.5 s
        [0.1235, 0.1708], // high band: steepest step in 0.1 s, 10 dB, mean of 0.5 s
        [0.1476, 0.1329], // high band: activity in the last 4 s, mean of 0.5 s
        [-0.5531, 0.8285], // high band: ratio to its own peak, 10 dB, mean of 0.5 s
        [-0.6700, 0.6599], // high band: decorrelation of 5.6–7 kHz, 10 dB, mean of 0.5 s
        [-0.7108, 0.6635], // high band: decorrelation of 4.4–5.6 kHz, mean of 0.5 s
        [0.3802, 1.1458], // high band: coherent rise of 5.6–7 kHz, 10 dB, mean of 0.5 s
        [0.3879, 1.1953], // high band: coherent rise of 4.4–5.6 kHz, mean of 0.5 s
        [1.0577, 1.1118], // high band: excess of 0.4–3.4 kHz over it, 10 dB, mean of 0.5 s
    ],
    weights: Cow::Borrowed(&[
        0.2638, 0.3783, -0.0395, 0.3282, 0.4068, 0.3354, -0.2172, -0.3126, 0.2320, 0.5483, -0.0183,
        -0.9122, 0.3104, -0.0052, -0.4761, 0.3916, 0.3430, 0.8016, 0.3707, -0.6401, 0.6149, -0.0314,
        0.1436, 0.1796, -0.4187, -1.0881, -0.0024, -0.3544, 0.0913, 0.0453, -0.4184, 0.6141, 0.0355,
        -0.1284, 0.2568, 0.2276, 0.0236, 0.1837, 0.0893, 0.1773, -0.1101, -0.0825, -0.6187, -0.2959,
        0.1115, -0.1948, -0.1175, 0.1871, -0.2926, 0.1565, -0.1514, -0.1167, 0.3397, -0.2299, -0.0465,
        -0.1828, -0.0115, 0.0287, -0.1504, 0.0991, -0.2112, 0.4586, 0.0824, 0.1020, 0.1100, 0.0272,
        -0.0280, 0.0598, -0.1198, -0.0253, -0.0733, 0.1203, -0.0912, -0.1723, -0.4222, -0.0800, 0.3049,
        -0.1029, -0.0191, -0.0153, -0.1492, 0.0491, -0.1490, -0.2420, 0.0766, -0.1650, -0.1864, -0.0046,
        0.0513, -0.0807, -0.1317, 0.2888, -0.0726, 0.0617, 0.0126, 0.1494, 0.1628, -0.0150, 0.0371,
        -0.1117, -0.1140, -0.1424, 0.1049, 0.1736, -0.1591, -0.2273, -0.1964, 0.0875, 0.0146, 0.0605,
        -0.0906, -0.0948, -0.1458, -0.1072, -0.1690, -0.1398, 0.2090, -0.0759, -0.0126, -0.1235, 0.0837,
        -0.0602, -0.1482, -0.0923, -0.1971, -0.1475, 0.0427, 0.0990, -0.0159, -0.0835, 0.0701, -0.0306,
        -0.0465, -0.0240, -0.0326, 0.1864, -0.1125, -0.1812, 0.0487, -0.0784, -0.0510, -0.0767, -0.0716,
        -0.1104, -0.0397, 0.0303, -0.0269, -0.1202, 0.0812, 0.0113, 0.0151, 0.0124, 0.0492, 0.0596,
        0.0165, -0.0537, 0.0438, -0.1181, 0.0541, 0.1163, 0.1272, -0.0877, 0.1646, -0.2000, -0.0791,
        0.0382, -0.0387, 0.2406, -0.1235, -0.1269, 0.0309, -0.0196, -0.0056, -0.1707, 0.1237, 0.0458,
        -0.0806, 0.2027, -0.0605, 0.0693, -0.0084, 0.0021, 0.0824, -0.0718, 0.0107, 0.0264, 0.1801,
        0.0468, 0.0865, -0.0171, -0.0850, 0.0596, 0.0278, -0.1290, 0.1946, -0.2388, -0.0663, 0.1266,
        0.0894, 0.1191, -0.0514, -0.0424, -0.1630, -0.0026, 0.1027, -0.0608, 0.0354, -0.0142, -0.1704,
        0.1778, -0.1217, 0.1323, 0.0607, 0.1193, 0.0304, -0.1390, -0.2058, -0.0115, 0.2639, -0.1035,
        0.1217, 0.1199, 0.0665, 0.0889, -0.1641, -0.0695, 0.1575, 0.2151, -0.0057, 0.0873, -0.0362,
        -0.2541, 0.0319, -0.0960, -0.4895, -0.2820, 0.2674, 0.1486, -0.1008, -0.0467, 0.0033, 0.0549,
        0.0110, -0.1673, 0.3392, -0.1255, -0.1596, -0.1390, 0.0129, 0.0727, -0.1773, 0.2550, -0.2494,
        0.3901, -0.0451, -0.0822, -0.0253, -0.0070, 0.0566, -0.1042, -0.0742, 0.1283, -0.0333, 0.0250,
        0.0019, 0.1968, -0.0436, -0.1737, 0.3021, 0.1726, -0.2236, -0.0143, 0.0841, 0.1522, 0.0677,
        -0.1557, 0.1233, -0.1198, -0.0757, -0.0554, -0.1954, -0.0003, -0.0037, -0.0122, 0.1404, -0.0460,
        -0.2469, 0.1599, 0.0643, 0.0029, 0.0645, 0.0761, -0.1325, 0.0168, 0.1332, 0.0854, -0.0155,
        -0.0732, -0.1887, -0.0434, -0.0668, -0.0406, 0.1750, 0.1277, -0.2521, -0.0202, -0.1410, -0.1014,
        0.1631, -0.0186, 0.0713, -0.0797, 0.0895, -0.0414, 0.0096, -0.1285, -0.1723, 0.1684, -0.0972,
        -0.1711, -0.0324, -0.0008, 0.0478, 0.1913, 0.0052, 0.0768, 0.1129, -0.1284, -0.0913, -0.0339,
        -0.0382, 0.0259, 0.0137, 0.2476, 0.0922, 0.0039, -0.1183, 0.1176, -0.1430, -0.0011, -0.0034,
        0.0505, 0.0965, -0.0753, 0.0520, 0.0674, -0.0266, 0.0150, -0.3287, 0.2580, 0.1014, -0.0885,
        -0.0719, -0.1554, 0.1698, 0.1260, -0.0416, -0.0513, 0.1778, 0.2764, -0.1053, 0.0762, -0.2684,
        0.1727, 0.0788, -0.1578, -0.0086, 0.1223, -0.1228, 0.1629, -0.0456, 0.0477, 0.0508, -0.0884,
        -0.0094, -0.0309, 0.2494, -0.0404, -0.0523, -0.0162, -0.1704, 0.1791, 0.0611, -0.1527, -0.1481,
        0.0118, -0.0930, 0.1140, 0.0465, -0.0733, 0.0721, 0.0118, -0.1878, 0.0601, 0.0980, -0.1168,
        -0.1878, -0.1393, 0.1587, 0.1203, -0.0041, -0.0013, 0.0479, 0.0973, 0.0543, 0.0094, -0.1771,
        0.0230, 0.1003, 0.0166, -0.1900, -0.0430, 0.0913, -0.0134, -0.0081, -0.0266, -0.1123, 0.0209,
        0.1028, 0.0336, 0.1388, -0.0735, 0.0432, -0.0048, -0.1428, 0.1098, 0.1358, -0.1121, -0.0606,
        -0.0987, 0.0641, 0.0711, -0.1363, -0.0566, 0.0855, -0.0442, -0.0183, -0.0929, -0.0853, 0.0127,
        -0.0912, 0.0234, -0.0532, -0.0384, -0.2039, -0.0997, -0.0511, -0.0517, 0.1093, 0.2201, -0.0650,
        -0.0418, -0.0533, 0.0351, 0.1250, 0.0756, -0.0038, 0.2388, 0.0557, 0.0300, 0.0179, -0.0761,
        0.0653, -0.0200, -0.0068, -0.1422, -0.0430, -0.0483, -0.0368, -0.1177, -0.0100, -0.0019, 0.1330,
        -0.1723, 0.2260, -0.0703, -0.2408, -0.1117, 0.0353, -0.0508, -0.1012, -0.0202, -0.1906, 0.2007,
        0.0469, -0.1325, -0.1675, -0.0872, 0.0165, 0.0131, 0.0768, 0.1403, -0.1101, -0.0259, -0.0220,
        -0.1146, 0.0401, -0.0783, 0.1178, -0.0460, -0.1778, 0.1742, 0.0075, 0.0593, -0.0965, 0.0480,
        0.0554, -0.1656, 0.0626, -0.2490, 0.1071, -0.1437, -0.0753, -0.1088, -0.0610, 0.0437, 0.0644,
        -0.0242, 0.0090, -0.0149, -0.1629, 0.0230, 0.0771, 0.0108, 0.0701, -0.0017, -0.0074, -0.1243,
        -0.1008, -0.0354, 0.1926, -0.0167, 0.0864, 0.0791, -0.1437, -0.0985, 0.0087, -0.0009, 0.0984,
        0.0479, 0.0434, -0.1724, -0.0791, 0.0777, -0.0421, -0.0801, 0.0864, -0.0181, 0.1117, -0.0390,
        0.3929, -0.0263, -0.0020, -0.0667, -0.2016, 0.1689, 0.1156, -0.0721, -0.0949, 0.0946, -0.1875,
        -0.0373, -0.0928, -0.0470, 0.2804, -0.3168, 0.0123, 0.2675, 0.1153, -0.0848, -0.0438, 0.0995,
        -0.1055, 0.0518, 0.0037, -0.0818, 0.0040, -0.1066, 0.3639, -0.1490, -0.0875, -0.0092, 0.1016,
        -0.0480, 0.0270, 0.0194, -0.0524, 0.0832, 0.1012, 0.0513, 0.0772, 0.0721, 0.0581, -0.1038,
        -0.0932, 0.1819, -0.0109, -0.0430, 0.1359, 0.0556, 0.0709, 0.0138, -0.0123, -0.1366, -0.0704,
        0.1278, -0.0275, 0.0544, -0.0239, 0.0015, 0.1796, 0.1309, 0.0753, 0.0816, 0.0462, 0.0162,
        0.0219, -0.0864, -0.3352, -0.0469, -0.0596, -0.0311, -0.0920, 0.0054, 0.0307, -0.0411, -0.1514,
        0.0576, -0.0902, -0.0737, -0.1153, -0.0634, -0.0934, 0.1070, -0.0766, -0.0883, -0.1389, 0.1178,
        -0.1275, 0.0118, 0.0028, 0.0282, -0.0419, 0.0989, 0.0392, -0.0037, 0.0038, 0.0180, -0.1427,
        -0.0209, -0.2072, -0.0724, 0.1405, 0.0523, 0.0973, 0.0785, -0.0930, 0.0092, -0.2140, 0.1386,
        0.2605, -0.1065, -0.1197, -0.0398, -0.0668, -0.1596, -0.1142, -0.0488, -0.1874, 0.2538, -0.0639,
        0.0736, -0.0118, 0.0425, 0.2347, -0.0797, -0.0646, 0.0296, -0.0529, 0.0883, -0.0060, -0.0209,
        -0.1003, -0.0064, 0.0457, 0.1026, 0.0444, -0.1424, -0.0256, -0.1065, -0.0704, -0.0298, -0.0112,
        -0.0389, -0.0349, -0.0879, -0.1431, 0.0109, -0.0265, 0.1103, -0.1347, 0.0968, 0.0429, -0.0622,
        -0.0224, -0.1091, 0.0138, -0.0072, 0.0189, -0.0747, 0.1167, -0.0100, 0.0177, -0.0700, -0.0609,
        -0.0660, 0.0662, 0.0253, 0.0006, -0.0028, -0.1163, -0.0601, -0.1487, -0.1131, 0.1356, 0.0813,
        0.0535, -0.0708, 0.0250, 0.0923, 0.0359, -0.1139, -0.0580, 0.0442, -0.0625, -0.0357, -0.0464,
        -0.0199, -0.1459, 0.1668, 0.0908, 0.0403, 0.3482, 0.0093, -0.2737, -0.0808, 0.0760, 0.0584,
        -0.1484, -0.0757, -0.0270, -0.0750, -0.2367, 0.0678, -0.0478, -0.0777, 0.0817, 0.0471, 0.2499,
        -0.1860, 0.1632, 0.0828, -0.0837, 0.0317, -0.3557, 0.1027, 0.1477, -0.2439, -0.0560, 0.0169,
        -0.1464, -0.0736, -0.0111, -0.1579, -0.0941, 0.0790, -0.0532, -0.1895, 0.0371, 0.0280, 0.1227,
        -0.0596, -0.1258, 0.0496, -0.1237, 0.1107, -0.1799, -0.0837, 0.0448, -0.0023, 0.0180, -0.0089,
        -0.0896, 0.0335, -0.0781, 0.1420, -0.1587, 0.1091, -0.0690, -0.1235, 0.0707, -0.1066, -0.0992,
        0.2795, 0.0309, 0.2545, -0.0083, 0.0471, -0.1832, 0.0101, -0.0787, 0.0374, 0.1464, 0.0044,
        0.1605, 0.0500, -0.0200, -0.1008, 0.0188, 0.0036, 0.0733, -0.1128, 0.0931, -0.0191, -0.0564,
        -0.1027, -0.1628, 0.1040, -0.2570, 0.1407, 0.0938, 0.0048, -0.0019, 0.0295, 0.0035, -0.0676,
        -0.0377, -0.0822, -0.0302, -0.0174, 0.0249, -0.2101, 0.0113, -0.0196, 0.1499, 0.0111, 0.0608,
        0.0515, -0.0135, 0.0476, 0.0625, -0.1341, 0.0326, -0.0042, 0.0556, -0.0914, -0.0597, 0.0387,
        -0.1894, 0.0854, 0.0256, 0.0433, -0.0261, -0.0992, -0.0476, 0.1338, 0.1536, -0.0212, -0.0195,
        0.1471, 0.0402, 0.2015, 0.1023, -0.1699, -0.0756, 0.0835, 0.2243, 0.0395, -0.1036, -0.1156,
        0.0203, -0.0834, -0.1858, 0.0237, -0.1453, -0.2067, 0.0979, 0.1619, 0.2487, -0.0664, 0.0093,
        -0.0061, -0.0390, 0.1658, 0.0440, 0.0384, -0.0290, 0.0117, -0.0062, -0.0007, -0.0097, -0.1223,
        -0.0461, 0.3075, 0.1761, 0.1879, -0.2613, -0.1485, 0.0287, 0.1795, -0.1316, -0.0535, 0.0188,
        0.0160, 0.0255, -0.0391, -0.1095, -0.0160, -0.0023, -0.0645, 0.0980, 0.1435, -0.1568, -0.1453,
        0.1687, 0.0652, -0.0363, -0.2146, 0.1804, 0.0878, -0.0559, -0.0913, 0.0420, -0.0417, 0.0764,
        -0.0245, -0.1065, 0.1184, -0.0236, 0.1169, -0.0323, -0.0890, -0.0073, -0.1144, -0.0893, 0.1105,
        0.1111, -0.0020, 0.0187, -0.1465, 0.0298, -0.0218, 0.1588, -0.1802, 0.1596, -0.2050, -0.0791,
        0.0221, -0.1266, -0.1548, 0.0877, -0.1137, 0.0230, 0.0350, 0.0134, 0.0486, -0.0454, 0.1292,
        -0.0080, -0.1073, 0.0939, -0.0558, 0.0426, 0.0391, 0.1428, 0.0029, -0.1249, 0.0093, 0.0115,
        0.1092, -0.0241, -0.1114, 0.0592, 0.0200, -0.0977, -0.0011, 0.0582, -0.0116, -0.1479, -0.1060,
        -0.0746, 0.0181, -0.2628, -0.0477, -0.0906, 0.4161, -0.0254, 0.2018, 0.1188, -0.0848, -0.0779,
        -0.1515, -0.1128, 0.0462, -0.0364, 0.2933, 0.0406, 0.1183, -0.0795, -0.2608, -0.1529, 0.0154,
        0.2018, -0.1023, 0.0503, 0.1867, 0.0196, 0.1556, -0.1221, 0.0078, -0.3474, 0.0559, 0.0166,
        -0.0910, -0.1485, -0.0158, 0.0441, -0.0908, -0.2457, -0.0670, -0.1930, 0.0240, -0.0033, -0.0480,
        -0.0979, -0.1434, 0.1661, -0.0345, -0.2039, 0.1470, -0.0533, -0.1089, -0.3386, 0.0546, 0.3207,
        -0.0054, 0.0557, -0.0873, -0.1914, -0.0748, -0.1205, 0.1827, 0.0856, 0.1049, 0.0432, 0.0055,
        0.4087, -0.1345, -0.0520, 0.1793, -0.0340, -0.0593, 0.1718, 0.4272, -0.0991, -0.1691, 0.0380,
        0.1076, -0.0177, -0.2212, -0.0996, -0.0239, -0.0598, -0.0331, -0.2719, -0.1045, -0.0194, 0.1310,
        0.1022, -0.1820, 0.1787, 0.1072, -0.0054, -0.0405, -0.1360, 0.0637, 0.2433, -0.0811, -0.0330,
        -0.1130, 0.0041, 0.0284, -0.0701, -0.0199, 0.1423, 0.0510, -0.1639, -0.3114, 0.0647, 0.1124,
        -0.2245, -0.1349, 0.0831, -0.0672, -0.1903, -0.0253, -0.0365, -0.1282, 0.2692, -0.0426, 0.0555,
        -0.1971, 0.1344, 0.0187, 0.0105, 0.0902, -0.0497, -0.0144, -0.0598, -0.1069, -0.0622, 0.1257,
        0.0582, 0.1228, 0.2069, 0.0761, -0.0584, -0.1138, -0.0781, -0.0098, -0.2463, 0.0420, 0.1870,
        0.0463, 0.0101, 0.0246, 0.1056, -0.0436, 0.1210, -0.0533, 0.2679, 0.0415, -0.2162, 0.1056,
        -0.1328, -0.2778, 0.0018, -0.1181, 0.1678, -0.0131, -0.0118, -0.0488, -0.0011, 0.1241, 0.0147,
        0.0130, 0.0907, 0.0815, 0.0534, -0.0810, 0.0210, 0.0058, 0.0941, 0.1744, 0.0161, 0.1037,
        -0.0537, 0.1328, 0.0553, 0.0282, -0.0897, 0.0812, -0.0368, -0.0164, -0.0011, -0.0219, 0.0920,
        0.0260, 0.2405, -0.1084, -0.0255, 0.0560, -0.0910, -0.1281, -0.1555, -0.1216, -0.0933, 0.0911,
        -0.1410, 0.1034, -0.0321, 0.0040, -0.1356, -0.0036, -0.1126, -0.0187, 0.0279, 0.0566, 0.0272,
        0.1309, 0.0785, -0.0820, -0.0881, 0.2230, 0.1942, 0.0071, 0.0414, -0.0622, 0.0587, 0.0604,
        0.0664, 0.0833, -0.0971, -0.0395, -0.0840, -0.0763, 0.0010, -0.0040, 0.0466, -0.1111, -0.0126,
        0.0681, -0.0164, -0.0620, 0.0883, 0.0476, 0.1225, -0.0714, 0.1392, -0.0411, 0.1327, -0.0661,
        0.1240, 0.0144, 0.0147, 0.0867, -0.1835, 0.0008, -0.0321, 0.1345, 0.0922, 0.0861, -0.0033,
        0.0166, 0.1039, -0.1217, 0.1130, 0.0326, 0.0188, 0.0117, 0.1164, 0.1818, -0.1785, 0.1085,
        -0.1257, -0.0260, -0.0209, -0.0017, -0.0356, 0.0455, -0.0634, -0.0572, 0.0358, -0.0647, 0.0261,
        -0.0831, 0.0090, 0.1407, 0.0378, -0.0776, 0.0527, -0.0416, 0.0522, 0.0128, -0.0138, -0.0083,
        -0.0245, 0.0679, -0.1077, 0.0484, -0.0052, 0.0191, 0.0739, 0.0720, -0.0287, 0.1071, -0.0553,
        0.0426, 0.0260, -0.0382, -0.0195, -0.0171, -0.0374, -0.1555, -0.0063, 0.0262, -0.0577, -0.0256,
        -0.0958, -0.0726, 0.0318, -0.0213, -0.0408, -0.0398, 0.0792, 0.0102, -0.0355, -0.0597, 0.0178,
        0.1425, 0.0364, -0.0468, 0.1842, 0.0432, 0.1537, 0.0861, 0.0941, 0.1121, 0.2391, 0.1891,
        0.0239, -0.0709, -0.0163, -0.1386, -0.0737, -0.3923, 0.1348, -0.1096, -0.2466, -0.1049, -0.0689,
        0.0305, 0.0863, -0.0652, 0.1452, -0.1598, 0.2117, -0.0693, -0.1808, -0.0252, -0.0859, 0.1418,
        0.3681, 0.0176, 0.1136, 0.0348, -0.0478, 0.0217, -0.0511, 0.1046, 0.1501, 0.0870, -0.1040,
        -0.1567, 0.0262, 0.1235, -0.0037, -0.0114, 0.1048, 0.0252, -0.1567, -0.1104, -0.1029, -0.1080,
        -0.0900, -0.0288, -0.0176, -0.0090, 0.1903, -0.0483, 0.0352, 0.0185, -0.1232, -0.1036, 0.1662,
        0.0067, 0.0662, -0.0785, 0.0057, 0.0417, 0.0223, -0.0465, 0.1515, 0.1892, -0.0901, -0.2579,
        -0.0051, 0.1878, -0.0936, 0.2419, 0.0257, -0.0131, -0.0852, -0.2236, -0.0154, -0.0471, -0.0070,
        0.0751, 0.1704, 0.0039, 0.2643, 0.1576, -0.1804, -0.0332, -0.1530, -0.1759, 0.0217, -0.1028,
        0.0472, -0.0778, -0.0570, 0.0298, -0.0499, -0.0781, 0.0403, 0.1317, -0.0247, -0.1777, 0.0742,
        0.1450, -0.0575, 0.0543, -0.0436, -0.0065, 0.0866, -0.1296, -0.1179, 0.1901, -0.0364, -0.0006,
        0.1761, -0.0449, 0.0831, 0.0430, 0.0893, -0.1254, -0.0262, 0.0432, 0.1040, 0.0378, -0.0177,
        0.0081, 0.0671, -0.1203, 0.0431, 0.0125, 0.0860, 0.1881, -0.0325, -0.1449, 0.0837, -0.0228,
        -0.0241, -0.1902, 0.0898, 0.0365, 0.0586, -0.0066, -0.1100, -0.0369, -0.0480, -0.0592, 0.0303,
        -0.0558, -0.0475, 0.0367, -0.0155, -0.0583, 0.0261, -0.0538, 0.0218, 0.0299, -0.0192, -0.1384,
        0.2764, -0.1262, 0.1356, 0.1636, 0.0950, 0.2043, 0.0766, -0.1136, 0.0673, -0.1317, -0.1154,
        -0.0055, 0.1351, 0.1089, -0.2220, -0.0869, 0.1234, 0.1277, -0.1659, 0.1068, -0.1083, -0.1774,
        -0.2488, -0.0931, 0.0493, -0.1031, 0.0792, 0.0396, 0.0015, -0.1588, -0.1440, 0.0314, 0.0588,
        0.0320, 0.0666, 0.1715, 0.1428, -0.2992, 0.0165, -0.0665, 0.0153, -0.1605, 0.0421, 0.1689,
        0.1164, -0.1514, 0.0512, -0.1126, 0.0772, -0.2028, -0.0030, -0.0981, -0.0815, -0.1364, -0.0420,
        0.1441, -0.1928, 0.1691, -0.2614, 0.1842, 0.0252, -0.2211, -0.1017, 0.0683, 0.1074, -0.2185,
        0.0335, 0.1290, -0.0017, 0.0084, 0.0479, 0.1806, -0.0019, -0.2933, 0.1827, 0.3140, -0.0811,
        0.0561, 0.2346, 0.0223, 0.1617, -0.2298, 0.0615, -0.1305, -0.1999, 0.0191, -0.2429, 0.0522,
        -0.0450, 0.0540, -0.1186, 0.1000, -0.2068, 0.1169, 0.1278, -0.0709, -0.0447, 0.0870, -0.0692,
        0.0079, 0.0276, 0.0771, -0.0854, 0.1746, -0.1703, -0.0955, -0.0763, -0.2569, 0.0985, -0.1697,
        -0.0257, 0.0057, -0.1699, -0.0178, 0.0263, 0.1937, 0.0644, -0.0211, -0.0660, -0.1229, 0.0581,
        -0.1127, -0.2241, 0.0669, 0.1304, -0.2359, -0.0417, 0.0560, 0.0286, 0.0098, 0.0343, 0.0420,
        0.0972, -0.0838, 0.0611, -0.0607, -0.0185, 0.0720, -0.1122, 0.0488, 0.0583, -0.2704, -0.1207,
        0.2260, -0.0125, 0.0452, 0.0897, -0.0757, 0.1140, -0.2484, 0.0240, -0.0629, -0.0970, 0.0779,
        -0.1872, 0.1718, 0.1119, -0.0752, 0.0668, 0.0188, -0.1963, 0.0907, 0.1197, -0.1617, 0.2483,
        0.0640, -0.0875, 0.0163, 0.0858, 0.1772, -0.0786, -0.1342, -0.0206, 0.0563, -0.1284, -0.0271,
        0.0171, -0.0183, -0.1204, 0.1004, 0.1864, 0.0056, 0.1154, -0.0954, 0.0648, -0.1453, 0.0681,
        0.0009, -0.0844, -0.1412, 0.0217, 0.0252, -0.0421, 0.0882, -0.0141, 0.0102, 0.0124, 0.0451,
        -0.1187, 0.1455, 0.0894, 0.0079, -0.1257, -0.0744, 0.0250, 0.1825, -0.0585, 0.1349, 0.1274,
        0.2197, -0.0101, 0.0591, -0.0310, 0.1749, 0.1033, -0.0887, 0.0470, 0.0103, 0.0848, -0.0485,
        0.0554, 0.0451, 0.1896, 0.0431, 0.0929, 0.0196, -0.0372, 0.0645, 0.0386, -0.2240, -0.1023,
        -0.0534, 0.0051, 0.0001, 0.0215, -0.1038, 0.1583, -0.0007, -0.3090, 0.0972, 0.0642, -0.2231,
        0.0736, 0.0503, 0.0945, 0.1640, -0.0841, -0.1308, -0.0052, -0.0043, -0.1490, -0.1490, 0.0144,
        0.1628, 0.1809, 0.0195, -0.0791, -0.0387, -0.0428, 0.0537, 0.0902, 0.0022, -0.0286, 0.0232,
        0.0167, 0.0510, 0.0320, -0.0474, 0.1296, -0.0888, -0.1137, -0.0379, 0.0575, -0.0436, 0.1491,
        -0.1536, 0.1203, -0.0865, 0.1034, -0.1152, 0.1038, -0.2335, -0.0667, -0.1363, -0.0811, -0.1030,
        0.0505, -0.1234, 0.0258, -0.0551, 0.0591, 0.0611, -0.0079, -0.0681, -0.0136, 0.1400, 0.0327,
        0.1722, 0.0783, -0.0997, 0.0910, -0.1846, -0.1446, 0.0920, 0.1151, -0.0053, 0.1659, 0.1645,
        -0.1410, -0.1118, -0.0440, 0.0851, 0.0898, 0.0005, 0.0411, -0.1932, -0.0188, 0.0996, -0.1289,
        -0.0485, 0.0088, -0.0048, 0.1113, 0.2038, -0.0583, -0.0307, -0.1849, 0.0444, 0.0398, 0.0914,
        -0.0113, 0.0754, 0.0224, -0.2561, -0.0739, -0.0050, 0.0411, 0.0058, 0.0614, 0.1407, -0.0326,
        -0.0815, 0.0447, -0.0234, 0.0870, 0.0204, 0.1065, -0.0738, -0.1152, 0.0744, 0.2515, 0.0788,
        -0.0631, 0.0160, -0.1561, -0.1023, 0.2701, -0.0599, 0.1485, 0.0017, 0.1516, 0.1533, 0.1594,
        -0.2047, -0.0257, -0.0346, -0.0868, -0.1038, 0.0195, 0.0380, -0.0171, -0.2031, 0.0214, 0.1945,
        0.0304, 0.0906, -0.1033, -0.0816, -0.0466, 0.0679, -0.0185, 0.0066, -0.2123, -0.1215, 0.0988,
        0.0349, 0.0870, 0.0464, 0.0499, -0.0180, 0.0513, 0.1002, 0.0218, 0.0550, 0.0099, -0.2496,
        -0.0071, 0.0551, 0.1667, 0.0162, 0.0149, -0.1417, 0.1040, 0.0265, -0.0739, -0.0281, -0.0249,
        -0.0139, -0.0968, 0.0695, -0.0871, 0.1092, 0.0736, -0.0081, -0.0456, 0.0731, -0.0769, 0.1111,
        0.2072, -0.0040, -0.0277, 0.0191, -0.0804, 0.0943, -0.0069, -0.0038, 0.0441, 0.0372, 0.1823,
        0.1172, -0.0265, -0.0373, -0.0565, 0.1521, -0.0775, -0.0493, 0.0941, 0.1454, 0.0993, 0.0684,
        -0.0123, -0.0821, 0.0250, -0.0434, -0.0684, -0.0691, -0.0651, -0.0758, -0.0780, 0.1033, 0.0107,
        0.0756, -0.0508, -0.0965, -0.1025, 0.2076, -0.0721, -0.0130, 0.0164, 0.0470, 0.1079, 0.0075,
        0.0423, -0.0098, 0.0093, 0.1426, -0.1337, -0.0625, 0.0939, 0.0002, -0.1103, 0.0008, -0.0701,
        -0.0463, 0.0344, -0.0425, 0.0591, -0.0877, 0.0433, 0.0442, -0.0344, 0.0528, -0.0979, 0.0421,
        -0.0120, -0.0377, 0.0907, 0.1554, -0.0170, 0.0550, -0.0587, 0.0064, 0.0476, -0.0529, 0.1697,
        -0.0273, 0.1276, 0.0366, -0.1065, 0.0942, 0.1247, 0.1296, 0.0742, -0.1058, -0.1303, 0.0757,
        -0.0243, 0.0840, 0.0008, -0.0200, -0.0149, -0.0919, -0.0971, 0.1560, -0.0547, 0.0459, -0.0336,
        0.0320, 0.0917, 0.1009, -0.0593, 0.0929, -0.0278, 0.1059, 0.0408, -0.0721, -0.0629, -0.0376,
        0.0739, 0.0507, -0.1454, 0.0947, 0.1846, -0.0062, 0.0782, -0.0879, 0.0518, 0.0607, -0.1222,
        -0.1008, 0.0104, -0.0322, 0.1715, 0.1425, -0.1208, -0.1229, 0.0420, -0.0057, 0.2043, 0.0219,
        0.0160, 0.1671, 0.0047, 0.1176, -0.1874, -0.1652, -0.1831, -0.1414, -0.0483, -0.0080, -0.1861,
        -0.2745, -0.0874, 0.2373, -0.0386, -0.2231, 0.0655, -0.1444, -0.0611, 0.2425, -0.1676, 0.1055,
        0.1161, 0.2052, 0.0724, -0.0547, -0.0586, -0.0097, -0.0253, -0.1094, 0.1094, -0.0106, 0.0602,
        -0.1201, -0.0308, 0.0465, 0.1451, -0.0571, -0.0264, -0.0246, 0.0050, -0.0604, -0.2783, -0.1579,
        -0.0615, 0.1634, -0.1162, -0.0565, -0.0112, 0.1423, -0.0165, 0.0185, 0.0880, 0.0966, -0.0565,
        0.0686, 0.0776, 0.0950, -0.0893, 0.0400, -0.0679, 0.0593, -0.0534, 0.1039, 0.0108, 0.1927,
        -0.0289, 0.0788, -0.0252, -0.0140, -0.0203, -0.0019, 0.0963, 0.0568, 0.0769, -0.0560, -0.0251,
        0.0849, 0.0540, -0.1152, 0.0787, -0.1597, -0.1170, -0.0473, -0.1129, -0.1114, 0.2393, 0.0529,
        -0.0270, 0.1384, -0.0939, -0.0007, -0.0834, -0.1090, 0.1390, -0.0644, 0.0149, -0.1160, 0.0979,
        -0.0180, 0.0795, -0.0070, 0.0897, 0.0348, 0.1693, 0.0621, 0.0132, -0.0229, -0.0615, 0.0317,
        0.0471, -0.0342, -0.0267, -0.0031, -0.0277, -0.1559, -0.0362, -0.0274, -0.0064, -0.0128, -0.0677,
        0.0192, -0.0287, 0.0598, 0.0924, 0.1667, 0.0352, 0.1382, 0.2230, -0.1108, -0.0741, 0.0890,
        0.1041, -0.0919, 0.0583, 0.0251, 0.0189, 0.0008, -0.0028, -0.1002, 0.0144, -0.0870, -0.0327,
        -0.0548, 0.1037, -0.0437, 0.1039, 0.0248, -0.0086, 0.0675, -0.1188, 0.2336, -0.0995, -0.1213,
        0.0557, 0.0455, -0.0965, -0.0726, -0.0208, 0.2119, 0.0351, 0.1257, -0.0167, -0.1500, -0.0344,
        0.1818, -0.0358, -0.1562, -0.0459, 0.0979, -0.1385, -0.0016, -0.0301, 0.0040, 0.1960, -0.1533,
        0.0941, 0.0491, -0.1127, 0.0325, 0.0968, -0.0198, -0.0284, -0.2909, 0.0216, 0.0102, -0.0877,
        -0.0387, -0.0530, -0.1490, 0.1972, 0.0292, 0.0707, 0.0397, 0.0412, 0.1018, -0.0247, -0.1256,
        -0.0253, -0.1476, -0.1080, 0.0577, 0.0697, -0.1615, 0.0356, -0.1250, 0.0010, -0.0420, 0.0993,
        -0.1606, 0.0064, -0.0970, -0.1208, -0.0533, -0.1148, -0.0332, 0.0715, 0.0582, -0.0602, 0.0509,
        -0.0710, -0.0238, 0.1279, -0.0263, 0.0632, 0.0785, 0.0036, -0.0459, 0.0746, -0.0795, 0.0212,
        0.0021, -0.0299, 0.1194, 0.0265, 0.0432, -0.0341, -0.0939, 0.1163, 0.2080, -0.0515, -0.1051,
        0.0236, 0.0553, 0.0450, 0.0275, -0.0382, 0.0266, -0.1090, 0.1084, -0.0673, 0.0709, -0.0886,
        0.1924, -0.1172, -0.0323, -0.0135, -0.1519, 0.0898, -0.1114, -0.0783, 0.1025, -0.2718, 0.0988,
        -0.0334, -0.1567, -0.0230, -0.0888, -0.1169, 0.1267, 0.0729, 0.1233, -0.0700, 0.0385, 0.1092,
        0.1366, -0.0577, 0.1002, 0.0820, 0.2225, -0.1570, 0.0971, -0.0243, 0.1360, -0.1327, -0.0029,
        -0.1561, -0.0312, 0.0684, 0.0749, 0.0543, -0.0213, -0.0789, -0.0006, -0.2585, 0.0676, -0.0197,
        -0.1801, -0.0460, 0.0078, -0.0128, 0.0133, -0.0505, -0.0312, -0.0975, -0.1217, -0.0752, 0.1503,
        -0.0153, -0.0091, -0.0554, 0.0868, 0.2698, -0.0960, -0.0724, 0.0508, -0.1747, 0.0731, 0.3219,
        0.4785, -0.1009, -0.1713, -0.0330, -0.0033, 0.0565, -0.2183, -0.0731, -0.0075, -0.0163, 0.0166,
        -0.2273, -0.0790, -0.0750, 0.1312, 0.1836, -0.0314, 0.1436, 0.1976, -0.1176, 0.0014, -0.1978,
        0.0296, 0.1234, -0.0932, -0.0078, -0.0492, 0.0562, 0.0097, 0.0536, 0.0180, 0.0064, 0.1532,
        -0.0997, -0.2523, 0.0973, 0.0732, -0.2062, -0.0301, -0.0624, -0.0908, -0.2532, 0.0901, -0.0037,
        0.0470, 0.1630, -0.0327, 0.1074, -0.0797, 0.0839, 0.0662, 0.0671, 0.1591, 0.0076, 0.0620,
        -0.0426, -0.1024, -0.0923, 0.3059, -0.0664, -0.0045, 0.1054, -0.0088, 0.1370, -0.1530, -0.0149,
        0.0359, -0.0675, 0.1047, -0.0333, -0.0416, 0.1670, 0.0496, 0.1690, -0.1519, 0.2056, 0.1790,
        -0.0321, 0.2379, -0.0474, -0.0627, -0.0349, -0.2412, 0.0130, -0.2915, 0.2938, -0.1106, -0.0021,
        -0.1156, 0.0650, 0.2426, -0.0242, 0.0071, 0.1153, 0.0153, 0.0092, 0.0076, -0.0921, 0.0628,
        0.0615, 0.0512, -0.1362, 0.1337, 0.0511, 0.1123, 0.1626, -0.0800, 0.0502, 0.0193, -0.1567,
        -0.0582, 0.1447, 0.0245, -0.0081, 0.1339, 0.0901, -0.1499, -0.0300, 0.1036, -0.1992, 0.0141,
        -0.1419, 0.0534, -0.0745, 0.1282, -0.0658, 0.0364, -0.1641, -0.0151, -0.0652, -0.0160, -0.0602,
        0.0560, -0.1854, -0.0264, 0.0158, -0.0727, -0.0141, -0.0884, -0.0080, 0.2568, -0.0160, 0.1510,
        0.0733, 0.0237, 0.0936, -0.0333, 0.0268, 0.0966, -0.0070, -0.0921, 0.0203, -0.1400, 0.1713,
        0.0382, 0.0970, -0.1109, 0.0590, 0.1869, -0.1265, 0.1313, 0.0693, 0.2466, 0.0316, -0.0790,
        0.0835, 0.2138, 0.0739, 0.0254, 0.1310, 0.0887, -0.0193, 0.0768, -0.1115, -0.1287, 0.0558,
        0.0518, 0.1723, -0.0587, -0.0349, 0.0724, -0.1030, -0.1182, -0.0911, -0.1352, -0.0999, -0.0559,
        -0.0058, 0.1043, 0.0283, 0.0923, -0.1106, 0.0176, -0.0184, 0.0131, 0.0331, 0.0203, -0.1034,
        -0.2121, -0.0476, -0.0497, -0.0599, -0.1590, -0.1247, -0.1295, -0.0933, 0.0509, -0.0427, -0.0973,
        -0.0387, 0.0633, -0.0560, -0.0230, -0.0444, 0.0180, -0.0244, -0.0689, 0.0563, -0.0208, -0.1144,
        -0.0907, 0.1546, 0.0329, -0.1114, 0.0408, -0.0401, -0.0975, 0.0854, -0.1243, 0.0008, 0.0157,
        -0.0064, -0.0966, -0.0852, -0.0102, -0.0346, -0.0846, 0.0092, -0.0158, 0.1036, 0.0012, 0.0048,
        0.0880, -0.0797, -0.0306, 0.0740, -0.0608, -0.0535, -0.0341, 0.3264, 0.3642, 0.2852, -0.1008,
        -0.0887, 0.0236, 0.1098, 0.1924, -0.0156, 0.1590, 0.0541, -0.0837, 0.0554, -0.2910, 0.0589,
        -0.1965, -0.2169, -0.0564, 0.0402, -0.1371, -0.1550, 0.0918, 0.0258, -0.1927, 0.1694, -0.1636,
        0.0144, 0.2545, 0.1148, 0.3318, 0.3845, 0.0535, 0.1720, 0.1456, -0.1262, 0.0215, -0.2106,
        -0.0150, -0.0746, 0.1047, 0.0368, -0.1349, 0.0432, -0.0803, 0.1412, 0.0320, -0.0243, -0.1244,
        -0.2095, -0.0436, -0.1152, 0.0450, -0.1577, 0.0289, -0.0972, -0.0984, 0.1461, 0.0010, -0.0622,
        0.0539, -0.0298, -0.0446, 0.1041, -0.0174, 0.2118, -0.0641, -0.0063, 0.0128, -0.0706, 0.0296,
        0.1198, 0.0889, 0.1029, -0.5238, 0.0137, 0.1880, -0.1427, 0.2675, 0.0497, -0.0425, -0.2296,
        -0.1660, -0.1767, 0.2105, -0.1161, 0.0586, 0.0408, -0.1485, 0.1673, 0.2457, -0.1065, -0.0751,
        -0.1157, -0.1292, 0.0541, -0.0582, -0.1591, -0.1552, -0.0268, 0.1707, 0.0262, -0.0477, 0.0015,
        0.1585, 0.1008, -0.2781, 0.0368, 0.1402, -0.0943, -0.0653, 0.0238, -0.1040, -0.2165, -0.0268,
        -0.0681, 0.2452, -0.1148, 0.1198, 0.1523, -0.1049, 0.1002, -0.0071, -0.1599, 0.0200, -0.0022,
        0.0402, 0.0948, 0.0830, 0.0393, -0.0530, 0.0979, 0.0805, 0.0839, 0.0948, -0.2039, 0.2116,
        0.0275, -0.1543, -0.0205, 0.1320, -0.1017, -0.2501, -0.1421, -0.0368, -0.0257, 0.0873, 0.0694,
        0.0499, -0.0954, 0.0891, -0.0960, -0.1909, 0.0089, -0.3471, 0.0223, 0.0399, 0.1099, -0.1761,
        0.0872, 0.1047, -0.0050, -0.0230, 0.2709, -0.1815, 0.1042, 0.0350, -0.0095, 0.0430, 0.0055,
        -0.2476, -0.0449, -0.0834, -0.0415, 0.0654, 0.0751, -0.0489, -0.3026, 0.0413, 0.3114, 0.2049,
        -0.0473, 0.1685, -0.0593, -0.5498, -0.2785, -0.3452, 0.1677, 0.1450, 0.1860, 0.0223, 0.1622,
        0.0661, -0.2075, 0.1547, 0.0510, 0.1527, -0.0949, 0.0917, 0.0634, -0.2764, 0.1736, -0.0627,
        0.1141, -0.2337, 0.1634, 0.2698, -0.0315, -0.2232, 0.0650, 0.1510, -0.0681, -0.1638, -0.0694,
        0.0465, -0.2014, -0.2505, -0.0391, 0.0970, -0.0958, 0.2027, -0.0263, 0.2448, -0.1768, -0.0505,
        -0.2340, -0.0555, 0.1213, 0.1444, 0.1651, 0.1054, -0.1404, 0.0292, 0.1562, 0.0578, -0.0433,
        -0.2193, 0.2234, 0.4734, -0.2644, 0.0331, 0.0661, 0.1972, 0.1553, -0.0847, 0.0707, 0.0321,
        -0.1732, -0.0565, -0.2958, 0.0161, -0.2298, 0.1052, -0.0219, 0.1432, -0.3050, 0.0806, 0.0816,
        0.0569, 0.2752, -0.0868, -0.1571, -0.0971, -0.0654, -0.1783, -0.3498, 0.2243, -0.0166, 0.0215,
        -0.0611, -0.1329, 0.1634, -0.4879, 0.0520, 0.2421, -0.3282, 0.0601, -0.1582, 0.3238, 0.1432,
        -0.0037, 0.0381, -0.1867, 0.1883, 0.1969, -0.2720, 0.1387, 0.2588, -0.2473, -0.2593, 0.1403,
        0.1545, -0.0606, -0.0709, 0.0078, 0.1092, -0.0403, -0.0571, 0.0873, -0.1106, 0.0086, -0.1613,
        0.3704, 0.0645, -0.3267, -0.2829, 0.2077, -0.0003, -0.0032, 0.0252, -0.0295, 0.1558, -0.3868,
        0.0017, -0.0427, -0.0596, 0.1079, -0.1764, 0.2019, -0.0159, -0.2689, 0.3956, 0.0168, -0.0614,
        -0.1512, 0.0298, -0.3730, 0.3222, 0.1275, -0.1615, -0.2181, -0.0643, -0.0474, -0.1798, -0.4214,
        0.1394, -0.0882, -0.3028, 0.1387, -0.0525, 0.1597, -0.1055, 0.0023, 0.1777, -0.0158, 0.0534,
        -0.2227, 0.1791, -0.1286, 0.0292, 0.0989, 0.1126, -0.0997, 0.2483, 0.0216, 0.0271, 0.0806,
        0.0059, 0.0330, 0.2624, -0.0550, -0.0801, -0.0547, -0.0934, 0.0205, -0.0660, -0.1436, 0.1448,
        0.1737, -0.1837, -0.0179, -0.1266, 0.0976, 0.0635, -0.1203, -0.1181, 0.2863, 0.1955, -0.0199,
        -0.0233, -0.0776, 0.0423, 0.0656, -0.0166, 0.2614, -0.0570, -0.1302, -0.0320, -0.0551, -0.0255,
        0.2300, -0.0076, 0.0134, 0.0067, 0.0376, -0.0055, -0.2081, -0.0937, -0.1922, -0.0499, 0.0449,
        -0.0593, -0.0332, 0.0327, -0.1166, 0.0515, 0.0508, -0.0537, 0.1723, 0.1177, -0.0824, 0.0128,
        -0.0091, -0.0554, -0.0900, 0.0148, 0.0475, 0.0293, 0.0608, 0.0171, -0.0318, -0.1104, 0.0017,
        0.0771, 0.0577, -0.0832, 0.1539, 0.0103, -0.0432, -0.1357, 0.0331, 0.1389, -0.2585, -0.1216,
        -0.0708, -0.1271, -0.0908, 0.0186, -0.1480, -0.0431, -0.1901, -0.1211, 0.0237, 0.0049, -0.0656,
        -0.1393, 0.0509, 0.0081, -0.1843, 0.0179, -0.1031, -0.0222, -0.0097, -0.0071, 0.1845, 0.1059,
        -0.1293, -0.1277, -0.0058, -0.0512, 0.1391, -0.0684, -0.0799, -0.0107, -0.0560, -0.1383, -0.0730,
        0.0361, -0.2281, 0.1548, 0.1184, -0.1350, 0.0698, 0.1566, -0.0530, 0.0774, -0.1591, 0.1761,
        -0.0734, 0.0378, 0.0227, -0.0473, -0.0231, -0.0444, 0.1111, 0.0545, 0.1534, 0.0257, -0.1092,
        -0.1379, -0.0770, -0.0329, 0.0792, -0.1013, -0.0880, 0.1424, 0.1015, -0.0618, -0.0203, 0.0582,
        -0.0965, 0.0559, 0.0642, -0.0595, 0.1188, 0.1082, -0.0025, 0.2206, -0.0619, 0.1680, -0.1413,
        0.0750, 0.0311, 0.1811, -0.0285, 0.0381, 0.0148, -0.1355, -0.0976, 0.1674, -0.2924, -0.1170,
        0.1279, 0.2420, 0.0204, 0.3054, -0.0412, -0.1017, -0.0421, 0.0578, 0.0561, -0.1446, 0.0572,
        -0.1675, -0.1767, -0.0049, 0.1189, 0.2368, 0.3391, 0.0175, 0.2753, 0.0666, 0.1211, 0.1319,
        0.0318, -0.1606, -0.0561, 0.0554, -0.0165, -0.0813, -0.2031, 0.0778, 0.0496, 0.0529, 0.0361,
        0.0206, 0.0726, 0.1218, 0.0448, -0.0807, 0.0700, 0.1240, -0.0400, 0.0733, 0.0389, 0.2153,
        -0.0023, 0.0377, -0.1326, -0.0590, 0.1492, 0.0394, 0.0005, 0.0455, -0.0567, 0.0395, 0.0398,
        -0.0358, -0.1399, 0.0018, 0.2140, 0.0190, 0.1423, 0.0618, -0.0375, -0.0653, -0.0878, 0.0089,
        0.0442, 0.0775, 0.0045, 0.1990, 0.0188, -0.0462, -0.1260, 0.0099, 0.1074, -0.0332, 0.0214,
        -0.0563, 0.0594, 0.1479, -0.0693, -0.2013, -0.0520, -0.1442, -0.0401, 0.0394, -0.1426, -0.0651,
        -0.2504, -0.0616, 0.0768, 0.0364, 0.1493, 0.2438, -0.1046, 0.0332, -0.1654, 0.0756, 0.0140,
        0.0564, -0.0577, 0.0297, -0.0689, -0.0104, -0.2063, 0.1516, -0.0703, -0.0475, 0.0861, -0.0912,
        0.0200, 0.0645, 0.1515, -0.1649, -0.0753, -0.1030, -0.1069, -0.0058, -0.2062, -0.0032, -0.0843,
        0.0909, -0.0700, -0.0288, 0.1242, 0.0181, 0.0403, 0.0795, -0.0519, 0.0673, -0.0284, 0.0231,
        0.0009, -0.0693, -0.0850, -0.0608, -0.0359, -0.0171, -0.0529, 0.0672, 0.0308, 0.0692, 0.1607,
        -0.0878, 0.0308, -0.1219, 0.0021, -0.1627, -0.0534, 0.0313, -0.1366, -0.0781, -0.1210, 0.1774,
        -0.0469, -0.1113, 0.0318, -0.0336, -0.0346, -0.0812, -0.0770, 0.0416, -0.1814, -0.0257, -0.0058,
        -0.1125, -0.1086, 0.0315, -0.0340, -0.2172, -0.0600, 0.0918, -0.0086, 0.0029, 0.0172, -0.1361,
        0.1525, -0.0712, 0.0949, -0.2063, -0.1437, -0.0716, 0.0144, 0.2307, 0.2560, -0.0269, -0.0025,
        -0.1423, 0.0975, -0.0357, 0.0428, -0.0249, 0.1933, 0.0646, 0.1644, 0.0732, 0.1621, -0.1947,
        0.0572, -0.1144, -0.0263, -0.1670, -0.1869, -0.2238, 0.1881, 0.0408, -0.1655, 0.0987, 0.2723,
        -0.1085, -0.0423, 0.2352, -0.0626, 0.2647, -0.1164, -0.0220, 0.0859, -0.1641, 0.2640, -0.0118,
        -0.0608, 0.0084, -0.1035, 0.1712, 0.1790, 0.0235, 0.1008, 0.0250, 0.3150, -0.1711, 0.0348,
        -0.0367, -0.0408, -0.0372, 0.1883, -0.2459, 0.2641, -0.0519, 0.0273, 0.0857, 0.0149, -0.0116,
        -0.1188, 0.2032, -0.1282, 0.1006, -0.0790, 0.1490, 0.1615, -0.1220, 0.0578, -0.1624, 0.1397,
        0.0667, 0.2214, 0.0544, 0.1811, -0.0585, 0.0348, 0.0292, 0.1206, -0.2081, 0.0864, -0.0843,
        -0.1266, -0.1613, -0.2374, -0.1672, 0.1121, -0.0702, -0.0472, 0.0178, 0.0643, 0.0015, -0.1034,
        0.1528, -0.3043, 0.1721, -0.1780, -0.0004, 0.1341, -0.2107, 0.0736, 0.1103, 0.0394, 0.0743,
        -0.1125, 0.0237, -0.0685, 0.0648, 0.1191, -0.0068, 0.0501, 0.0736, 0.0391, -0.1411, -0.1542,
        -0.0110, 0.0884, -0.2243, 0.1509, 0.1542, 0.0880, 0.0847, -0.1435, -0.0675, -0.0780, 0.1177,
        -0.2181, 0.0978, -0.1198, -0.4028, -0.0565, -0.2153, 0.1625, -0.0263, 0.4997, 0.0160, 0.3599,
        0.2776, -0.0366, 0.1060, 0.1480, -0.0168, -0.0820, -0.1063, -0.0596, -0.1114, -0.1516, -0.1632,
        0.0492, -0.0158, -0.0720, 0.0553, -0.0577, 0.2905, 0.0687, -0.0941, 0.0577, 0.1849, -0.0030,
        0.1350, -0.0242, -0.1532, -0.0072, 0.0969, 0.1475, -0.3815, -0.2189, -0.2063, 0.2692, 0.1712,
        0.1648, -0.0742, -0.1704, -0.0911, 0.0061, 0.0793, -0.2972, 0.0772, 0.0955, 0.4027, -0.0295,
        -0.1694, 0.1293, 0.3548, -0.2305, -0.0017, -0.2091, -0.0339, -0.0242, 0.2690, -0.0309, -0.0058,
        -0.1659, 0.0226, -0.0320, 0.1344, -0.1764, -0.0612, -0.1634, 0.0757, 0.0873, -0.0009, 0.3425,
        -0.0202, -0.0979, -0.1466, 0.0702, 0.0607, -0.2655, -0.0500, -0.0105, -0.1462, 0.0073, 0.1738,
        -0.0283, -0.0010, -0.1620, -0.0624, 0.1891, 0.0707, 0.0291, -0.2423, 0.1420, -0.0428, -0.1469,
        0.2227, -0.2759, -0.0028, -0.0720, 0.1295, 0.0306, 0.1042, -0.1843, -0.2158, -0.0299, -0.0037,
        -0.0258, 0.2361, 0.0658, -0.1157, 0.0917, 0.0176, 0.1392, 0.1699, -0.0384, 0.1338, -0.0074,
        0.0462, 0.0029, -0.0273, 0.0789, 0.0728, -0.0273, -0.0233, 0.2614, -0.0467, 0.1166, 0.0047,
        0.0051, 0.0153, 0.0359, -0.0216, 0.3280, 0.1036, -0.1037, 0.1032, -0.2743, 0.0515, -0.2120,
        -0.0409, 0.1499, -0.3675, 0.0671, -0.2751, -0.0522, -0.1340, 0.0210, -0.0970, 0.3013, 0.1151,
        -0.0398, -0.0459, 0.1659, -0.1101, 0.1615, -0.2094, 0.0533, 0.0220, 0.2227, -0.1591, 0.0422,
        -0.0757, 0.1143, -0.0911, 0.1227, -0.0290, -0.0636, 0.0764, -0.0974, -0.0361, -0.0938, -0.1131,
        0.1696, -0.3986, -0.0393, -0.1379, -0.0750, -0.1276, 0.2518, -0.0331, 0.1531, -0.0849, 0.0028,
        -0.0802, -0.1099, -0.0722, 0.0847, -0.1254, -0.0344, -0.0792, 0.0607, 0.3668, -0.0495, 0.0305,
        0.0005, -0.0365, -0.0678, 0.2154, 0.3010, -0.2395, -0.2033, 0.0814, 0.0976, 0.0125, -0.2983,
        -0.2596, 0.0449, -0.0973, -0.1104, -0.2786, 0.0226, 0.0639, 0.1481, 0.0852, -0.1347, -0.0118,
        0.2031, -0.0440, -0.0107, -0.1205, 0.0575, 0.1798, -0.0448, 0.0771, -0.0814, 0.0166, -0.0760,
        -0.0392, 0.0304, 0.0952, 0.0275, -0.1769, -0.2262, -0.0806, 0.1118, -0.3704, -0.2195, -0.0572,
        0.1047, -0.2085, 0.1311, -0.1145, -0.0433, 0.2484, -0.0296, 0.0713, -0.2867, -0.0521, 0.0960,
        0.0049, 0.0007, -0.0318, -0.0286, -0.0639, 0.0589, -0.1070, 0.4304, -0.1302, 0.0499, 0.3348,
        -0.1580, 0.0942, -0.1766, 0.0993, 0.1386, 0.1216, -0.1005, -0.0240, -0.1166, 0.1139, -0.0077,
        -0.0895, -0.1189, 0.1916, 0.0754, -0.0372, 0.4098, -0.1220, -0.0931, 0.0146, -0.4720, 0.2331,
        -0.2565, 0.4856, -0.2328, -0.1793, 0.0055, -0.1420, 0.2725, -0.1397, 0.2203, 0.1667, 0.0284,
        0.1142, 0.0115, 0.0842, 0.1076, 0.0507, -0.0854, -0.0608, 0.3059, 0.1209, 0.1056, 0.0353,
        0.0119, 0.0223, 0.2441, -0.1571, 0.1217, -0.0105, -0.0341, 0.0208, 0.0506, 0.0360, -0.0589,
        0.1490, 0.0009, -0.1862, -0.1445, -0.1899, 0.0081, -0.1993, -0.0011, -0.0229, 0.0265, -0.3934,
        -0.0412, 0.0389, 0.1985, -0.1413, 0.0892, -0.0098, -0.1557, -0.0137, -0.1158, 0.1843, 0.0830,
        0.2277, -0.1463, 0.0151, -0.0176, 0.1938, 0.0913, 0.0761, -0.2567, 0.1778, 0.1016, 0.2253,
        -0.1275, 0.0976, -0.2644, 0.0877, 0.0405, -0.1388, 0.1271, -0.0139, 0.2570, 0.0494, 0.0687,
        -0.0006, 0.1050, -0.1799, -0.0503, 0.0185, 0.1344, 0.2230, 0.0624, 0.2808, -0.0270, -0.0544,
        0.1716, 0.2457, -0.1065, -0.0058, 0.1321, 0.1259, -0.0567, -0.0244, -0.3425, -0.0973, -0.1183,
        0.0524, -0.1713, 0.0532, 0.1488, -0.0593, 0.0660, 0.0687, 0.0043, -0.1081, 0.0063, -0.0185,
        -0.0346, 0.0137, -0.0282, -0.0175, -0.0789, 0.0667, 0.0486, -0.0318, 0.0179, -0.0225, 0.1294,
        -0.0690, 0.0501, -0.1285, -0.0121, 0.0817, 0.1065, 0.1153, -0.0279, -0.0177, -0.1062, 0.0884,
        0.0090, 0.1081, 0.2302, 0.0257, 0.1459, 0.0941, -0.1726, -0.1279, -0.0358, -0.0364, -0.0432,
        -0.0435, -0.1052, 0.0389, 0.0585, 0.0376, 0.0084, 0.0258, -0.0075, 0.0920, 0.1383, 0.0894,
        0.0769, -0.0749, 0.0319, 0.1229, -0.0421, 0.0915, 0.0030, -0.0733, -0.1073, 0.0854, 0.0415,
        0.2569, 0.2805, -0.2127, -0.5131, -0.8150, 0.2062, -0.6411, -0.0487, 0.2010, 0.0175, 0.5561,
        -0.4151, 0.7105, -0.1871, -0.4072, 0.0075, 0.5223, -0.5392, 0.1770, -0.7811, 0.2862, -0.5162,
        0.1499, 0.2261, -0.4993, -0.3602, 0.3000, 0.0857, 0.6160, 0.0849, -0.2230, 0.4995, 0.2575,
        0.0527, -0.0531, -0.2085, -0.0275, -0.1468, -0.0650, 0.0228, 0.0563, -0.1934, 0.3286, 0.1237,
        -0.0535, -0.3343, 0.0009, -0.1948, -0.0422, -0.6265, 0.4661, -0.0218, 0.2252, 0.0037, -0.0217,
        -0.0995, -0.1706, 0.1920, 0.1826, -0.3113, 0.0366, -0.2236, 0.1047, 0.0994, 0.2034, 0.0387,
        -0.2361, -0.2030, -0.0146, -0.1780, -0.1951, 0.0282, 0.0028, 0.1010, 0.2370, -0.0120, -0.0033,
        -0.2435, -0.0910, -0.1276, 0.2048, -0.2992, 0.1454, -0.0822, -0.0376, -0.1017, -0.0193, 0.1542,
        -0.2729, 0.0557, -0.0509, -0.1553, 0.1122, -0.0861, 0.0821, 0.1923, 0.0880, 0.1213, -0.1298,
        -0.2444, -0.0821, 0.0461, 0.0550, 0.1030, -0.0963, 0.0438, 0.0576, 0.0864, -0.0963, -0.0908,
        -0.1057, 0.0128, 0.2829, -0.1943, 0.0531, -0.1129, 0.2885, -0.0666, -0.0844, 0.0421, -0.2018,
        0.2033, 0.0916, -0.2367, 0.0569, 0.0408, 0.0619, -0.0118, 0.1199, -0.0444, 0.0216, -0.0764,
        -0.0838, 0.0264, -0.0978, 0.2484, -0.1188, 0.0202, 0.0619, -0.0987, -0.0030, -0.0960, -0.0567,
        -0.0067, 0.0971, 0.0861, -0.0134, -0.0514, -0.0204, -0.0140, -0.0076, 0.0882, 0.0426, 0.0144,
        0.0745, -0.1353, 0.1712, -0.0068, -0.0255, 0.0869, 0.1743, 0.0408, 0.2112, -0.0651, 0.0055,
        -0.0402, -0.0626, 0.3055, -0.1404, -0.0477, 0.0206, 0.0374, 0.0774, -0.1751, 0.0263, 0.0420,
        -0.0505, 0.1020, -0.0714, 0.0314, 0.0575, -0.0326, -0.0867, 0.0553, 0.0352, 0.0706, 0.1998,
        -0.1249, 0.1094, -0.0244, 0.0503, 0.1757, 0.1112, -0.0222, 0.2005, -0.2183, -0.0607, -0.0657,
        0.0859, 0.2332, 0.0344, -0.0901, -0.1009, -0.0162, 0.0754, -0.1097, 0.1136, -0.1113, -0.2096,
        0.2226, 0.0146, 0.0335, 0.1146, 0.0415, 0.0141, -0.1172, -0.1147, 0.0088, 0.3540, -0.1182,
        0.2247, 0.1148, 0.1452, 0.0558, 0.2193, 0.0486, -0.2437, -0.1029, -0.1469, -0.1949, 0.0369,
        -0.0821, 0.0162, -0.0237, 0.5654, 0.2019, -0.1437, 0.1151, 0.0303, 0.0532, 0.0455, -0.6357,
        0.0918, 0.0908, 0.1316, 0.0290, 0.0977, 0.1480, 0.1499, 0.1329, -0.0682, -0.3068, -0.0277,
        -0.3918, 0.2127, -0.0338, 0.1213, -0.0441, 0.1051, -0.1551, 0.0123, -0.0518, -0.0442, 0.1081,
        -0.1460, 0.0267, 0.0362, 0.0472, 0.1184, 0.1296, 0.0873, -0.0212, 0.0612, 0.1596, -0.0062,
        0.1048, 0.1752, 0.0051, -0.0152, -0.0393, 0.0847, -0.0191, 0.1658, 0.0100, 0.0009, 0.0838,
        0.1499, -0.0435, -0.0209, 0.0904, -0.0630, 0.2256, -0.1075, -0.3106, -0.0868, 0.1669, -0.0289,
        0.0109, 0.4535, 0.1015, -0.0114, -0.1551, 0.1450, -0.3096, 0.0735, -0.7779, 0.5751, 0.1250,
        -0.0896, 0.0149, 0.2936, 0.0198, 0.1821, 0.3509, -0.0708, -0.6338, -0.2186, -0.2066, 0.4561,
        -0.1364, 0.0595, 0.0079, -0.3778, 0.3645, -0.1192, -0.3153, 0.1403, -0.0713, 0.0178, -0.0556,
        0.8110, 0.2216, -0.0606, -0.0992, -0.0224, -0.2566, -0.0173, -0.6650, 0.2146, -0.0639, -0.1299,
        -0.0360, 0.2121, 0.1645, 0.1739, -0.0113, -0.0142, -0.3778, -0.2610, -0.3732, 0.2477, 0.1936,
        0.0939, -0.0081, -0.0220, 0.0143, -0.1511, 0.1804, 0.1072, 0.0830, 0.0939, -0.1070, 0.6947,
        -0.2593, -0.0517, -0.1782, -0.2597, 0.0386, 0.1233, -0.5346, 0.3248, -0.2239, 0.2471, 0.1998,
        0.1083, -0.0085, -0.2161, 0.0237, -0.1454, -0.1369, 0.0681, -0.1796, 0.0905, 0.1829, 0.0105,
        -0.0313, -0.1108, -0.0071, 0.0282, 0.0979, 0.0225, 0.0376, -0.0634, 0.1538, 0.0355, -0.1517,
        -0.0733, -0.0672, 0.0127, 0.2417, -0.0813, 0.0246, -0.0256, 0.1786, 0.0821, 0.0033, -0.0229,
        0.0828, 0.0464, -0.1278, -0.0693, -0.0554, -0.0146, -0.0563, 0.1297, -0.0272, 0.0179, 0.0004,
        0.1246, 0.0595, 0.0136, -0.0779, -0.0064, -0.0713, -0.2025, 0.1560, 0.0177, -0.0602, -0.1445,
        -0.1269, 0.0942, 0.2332, -0.0014, -0.0617, 0.1264, -0.0418, 0.0688, -0.0315, -0.0975, -0.0264,
        -0.0741, -0.0069, -0.2221, -0.0375, -0.1840, -0.0570, -0.0012, -0.1075, 0.1091, 0.1571, -0.1221,
        0.0178, -0.2509, -0.0520, 0.0891, 0.0646, -0.0329, 0.0616, 0.6766, 0.1150, -0.1608, -0.0607,
        -0.2187, -0.2151, 0.0034, -0.5855, 0.1594, -0.2833, 0.1214, 0.2302, 0.1060, -0.0309, 0.0287,
        -0.2513, 0.1972, -0.3676, -0.1578, -0.1516, 0.2994, 0.0877, 0.1137, -0.0635, -0.0163, 0.1030,
        0.0137, 0.0686, -0.1273, 0.0188, -0.0513, -0.0357, -0.0322, -0.0733, 0.0613, -0.1258, 0.1986,
        0.1187, 0.0439, 0.0501, -0.0753, 0.0304, -0.2332, -0.1352, 0.0431, -0.0667, -0.1103, -0.1600,
        -0.0325, 0.0782, -0.0346, -0.0339, -0.0872, 0.0170, 0.1280, -0.1515, 0.1141, 0.0195, -0.1559,
        -0.0353, 0.0664, -0.0448, -0.1166, 0.0913, -0.0948, 0.0217, 0.1690, 0.0600, 0.0743, -0.0433,
        0.0358, 0.0118, 0.0412, 0.0368, -0.1217, -0.1200, -0.0400, 0.0086, 0.0122, 0.0385, 0.0535,
        -0.1432, -0.0177, -0.0015, 0.0376, 0.1745, 0.3547, -0.1689, -0.0187, 0.1944, -0.1893, -0.2037,
        0.2253, -0.0828, -0.1257, -0.1388, 0.6913, 0.5375, -0.2043, -0.1888, -0.1110, -0.2589, 0.0748,
        -0.7307, 0.4502, 0.3305, -0.0818, 0.0108, -0.1395, 0.0161, 0.0262, 0.1133, 0.2877, -0.4970,
        -0.2739, -0.3025, 0.3208, -0.0424, -0.1083, -0.0605, 0.3624, -0.0775, -0.1141, 0.1159, 0.0566,
        0.0122, -0.0112, 0.0752, -0.0478, 0.0422, 0.0910, 0.0715, 0.0796, 0.0991, 0.0455, 0.0169,
        -0.1450, -0.0243, -0.1886, 0.0168, 0.1029, 0.1132, -0.0388, 0.0287, 0.0334, -0.0867, -0.0808,
        0.0552, 0.0422, 0.0728, -0.0811, -0.0395, 0.1343, -0.1650, -0.0545, -0.0657, 0.1281, 0.0246,
        -0.1904, -0.0290, 0.3965, -0.0100, 0.1284, 0.0468, -0.1440, -0.3497, 0.0061, -0.0379, 0.0555,
        -0.0824, -0.0294, 0.0767, 0.2390, -0.0051, -0.0728, -0.0934, 0.1679, -0.1065, 0.0649, -0.0029,
        0.1191, -0.0287, 0.0583, -0.0654, -0.0668, 0.0601, -0.3674, -0.1753, -0.0072, -0.0665, -0.1451,
        0.0804, 0.1612, 0.1752, 0.0271, -0.0244, -0.1096, -0.3092, 0.0203, -0.2535, 0.0506, -0.0148,
        0.1373, -0.0967, 0.1691, -0.1259, 0.0103, -0.1394, 0.1206, -0.1346, 0.0080, 0.0865, 0.1110,
        -0.0017, 0.1161, -0.0581, 0.1544, -0.0532, -0.0754, 0.0172, -0.0078, 0.0449, -0.0441, -0.0833,
        0.0258, -0.0175, 0.0110, -0.0020, -0.0813, -0.0746, -0.0553, 0.0079, -0.0479, -0.0383, 0.0379,
        -0.0825, 0.0632, 0.0275, -0.0624, 0.1143, -0.0875, 0.0453, -0.0817, 0.1131, -0.0240, -0.0712,
        -0.0541, -0.1685, -0.0201, 0.1229, -0.0766, 0.0325, 0.1174, -0.0682, -0.0851, -0.0851, 0.0076,
        -0.0970, -0.0004, -0.0056, 0.0864, 0.0369, -0.1002, 0.0785, -0.1213, -0.0796, 0.0986, 0.0839,
        -0.0122, -0.0511, -0.0804, -0.1233, 0.0362, 0.0124, -0.0054, 0.1019, 0.0066, 0.0759, -0.1180,
        -0.2330, -0.3942, 0.0722, 0.3560, 0.2503, 0.5748, -0.1636, -0.4381, -0.3295, 0.2983, -0.1045,
        -0.1953, -0.2243, 0.1553, 0.2553, -0.0073, -0.5434, -0.0958, 0.0925, 0.3354, 0.1796, -0.1302,
        0.0803, 0.2115, 0.0337, -0.0869, -0.7090, -0.1791, -0.5424, -0.0138, -0.3361, -0.0816, 0.0337,
        -0.1015, 0.0285, -0.0759, -0.0125, 0.0618, 0.0465, -0.0143, -0.1672, 0.1822, 0.0010, 0.1230,
        -0.0958, -0.1707, 0.0405, -0.0500, 0.0816, -0.2377, -0.0294, 0.0869, -0.0412, -0.0004, 0.0010,
        0.0329, 0.0709, -0.1667, 0.1086, -0.0412, 0.0805, -0.0773, -0.0397, -0.0111, 0.0184, -0.1723,
        0.0386, 0.0376, -0.1326, 0.0524, 0.0530, -0.1613, -0.0718, -0.1263, -0.0140, -0.0258, 0.0541,
        -0.2239, -0.3254, 0.0480, -0.0043, 0.0258, -0.0726, 0.1720, 0.0811, -0.1414, -0.1607, -0.0333,
        -0.1604, 0.0617, -0.1467, 0.0129, -0.3004, 0.1622, 0.1235, 0.0904, 0.0195, 0.0012, -0.0471,
        -0.0667, -0.0992, -0.0566, -0.0475, 0.0016, -0.2045, 0.1110, 0.0124, 0.1106, -0.0439, -0.0181,
        0.0820, 0.0052, 0.0042, -0.0571, -0.0373, 0.0058, 0.0267, 0.1074, -0.0551, 0.1352, -0.0170,
        -0.2526, 0.0849, 0.0458, 0.0303, 0.0612, 0.0284, 0.1760, 0.0654, 0.2460, -0.1193, -0.0346,
        -0.0103, 0.2228, 0.0626, -0.0401, 0.0487, 0.0700, -0.2231, 0.0526, -0.0689, 0.1554, -0.1137,
        -0.0921, 0.0495, 0.0293, -0.0030, 0.0144, -0.0161, 0.2004, -0.0943, -0.0784, 0.1692, 0.1123,
        -0.0428, 0.1186, -0.0290, -0.0020, 0.3137, -0.0001, -0.0234, 0.0449, -0.0326, 0.0858, -0.1488,
        -0.1378, 0.2363, 0.1678, 0.2243, 0.1809, -0.1211, 0.0501, -0.0789, -0.2192, -0.0160, -0.2471,
        -0.0711, -0.1899, 0.1153, 0.1493, 0.1146, -0.0930, -0.1037, -0.1854, 0.0599, -0.0258, -0.0321,
        0.1941, 0.2461, 0.0202, 0.0906, -0.2169, 0.0766, 0.0453, 0.3197, 0.1040, 0.2920, 0.0969,
        0.0273, 0.2736, -0.0492, -0.1741, -0.1986, -0.1402, 0.0958, -0.1024, 0.3507, -0.0120, 0.0400,
        -0.0322, -0.2400, 0.1951, 0.2414, -0.1934, -0.0558, 0.0956, -0.0363, -0.1728, 0.0280, -0.1085,
        0.0474, -0.4109, 0.2279, 0.0290, 0.0460, -0.0012, 0.0200, -0.1268, -0.0872, -0.0386, 0.1178,
        -0.0418, -0.0923, -0.1185, -0.0010, 0.1423, -0.0019, 0.1484, 0.0213, -0.0542, -0.1024, -0.0827,
        -0.0137, 0.0459, -0.0559, 0.0038, -0.0277, 0.1022, 0.0837, 0.1160, 0.0450, 0.0459, -0.0756,
        -0.0169, -0.0914, -0.3818, -0.5132, -0.1258, 0.6262, -0.1694, 0.0144, 0.6648, -0.2137, -0.3133,
        -0.0876, 0.9741, 0.0204, -0.0632, 0.1021, 0.1892, -0.0546, -0.2854, -1.2862, 0.5864, 0.1708,
        0.6582, 0.2500, 0.3949, -0.2188, 0.4133, 0.2211, -0.0099, -1.4652, -0.2766, -0.4849, 0.2965,
        -0.4681, -0.1905, -0.0326, 0.0648, -0.1309, -0.2840, 0.0625, -0.2646, -0.0399, 0.0193, 0.0088,
        -0.0802, -0.1585, 0.1833, 0.0429, -0.2198, 0.1124, -0.1716, -0.0956, -0.2828, -0.0778, 0.2778,
        -0.0310, -0.0606, -0.0127, -0.1708, -0.1009, -0.1528, 0.2347, 0.0509, 0.1224, -0.0560, 0.0627,
        0.1033, -0.2359, 0.3009, -0.1542, 0.4926, -0.0019, 0.1500, 0.0852, -0.1971, 0.0400, -0.0993,
        0.0630, -0.0660, -0.3141, -0.0102, 0.2285, 0.2067, 0.0959, -0.0784, -0.1411, 0.2606, 0.1600,
        -0.2689, -0.2631, -0.4454, -0.2375, 0.3911, -0.0135, -0.2281, 0.2028, -0.3843, 0.2763, -0.1071,
        0.0448, 0.0813, -0.1620, 0.0531, 0.0966, -0.0236, 0.1836, -0.0693, -0.1168, 0.0650, -0.1687,
        -0.2046, -0.1593, -0.0888, -0.0596, -0.1370, 0.1489, 0.0554, -0.2240, 0.0551, -0.1573, -0.0613,
        -0.1422, 0.0203, -0.0176, 0.0817, 0.0351, 0.0871, 0.0059, -0.0216, -0.0070, 0.3996, -0.0377,
        -0.0592, -0.1665, -0.2175, 0.1330, 0.0038, -0.0455, 0.1465, -0.0624, 0.0717, 0.1296, -0.1049,
        0.0293, -0.4339, 0.0410, 0.0827, -0.0918, -0.1132, 0.3163, -0.0523, -0.3343, -0.2910, 0.4170,
        0.1812, 0.0013, 0.1110, -0.2244, 0.0079, 0.0688, 0.0204, -0.2526, -0.0130, 0.1695, 0.0432,
        -0.1124, -0.0265, 0.1353, -0.1109, -0.0966, -0.0555, -0.0151, 0.0310, 0.1839, -0.0882, 0.0756,
        -0.0755, 0.0717, 0.2061, -0.0053, -0.1178, 0.0525, 0.0333, 0.0492, -0.0440, 0.0349, 0.1743,
        0.1050, 0.1691, -0.0247, -0.1122, -0.0622, -0.0693, -0.0894, -0.0564, -0.0498, 0.0107, 0.0171,
        -0.0475, 0.0747, -0.0111, 0.0899, -0.2172, 0.0483, -0.0145, 0.0334, -0.0590, -0.1348, 0.0002,
        0.1588, -0.0242, 0.0333, -0.1421, 0.2437, 0.1435, -0.0943, 0.1118, -0.1855, 0.0852, -0.0969,
        -0.1043, 0.1468, -0.0442, -0.0878, 0.0354, -0.1240, 0.1574, 0.0187, -0.0709, -0.0669, 0.0085,
        -0.0205, -0.0902, 0.0294, 0.0015, 0.0437, -0.1873, 0.0653, -0.0496, -0.0125, 0.0054, 0.0859,
        -0.0114, 0.1983, -0.2224, 0.1186, -0.1368, 0.0127, -0.1029, 0.0759, -0.0245, 0.0058, 0.0338,
        0.1739, -0.0974, -0.0258, -0.0245, 0.0984, 0.0297, 0.0215, 0.1600, 0.0003, -0.1297, 0.0394,
        0.0235, -0.0414, -0.0610, 0.0228, -0.0638, 0.0451, -0.0443, -0.1955, 0.0441, 0.0188, -0.0296,
        0.0819, -0.0775, 0.0843, 0.0159, -0.0441, -0.0136, 0.0089, 0.0693, 0.0098, 0.0944, -0.1127,
        -0.0216, 0.1235, -0.0692, 0.0668, 0.0745, -0.0092, -0.0515, 0.0550, 0.0151, 0.0282, -0.0916,
        -0.0354, 0.0393, -0.0966, -0.0311, 0.0046, -0.0770, -0.0822, -0.0500, -0.0082, -0.0967, 0.0106,
        0.0373, -0.0564, 0.0095, -0.0113, 0.0615, -0.0789, 0.0179, -0.0023, -0.1277, 0.0792, -0.0532,
        0.0397, -0.0414, 0.0416, 0.3243, 0.1156, -0.0109, -0.2545, 0.1831, 0.1111, 0.0723, 0.0099,
        -0.0870, -0.2064, -0.0187, 0.0355, -0.3306, -0.1928, 0.0231, 0.2417, -0.1441, 0.0314, -0.0960,
        0.0024, 0.3680, 0.1144, -0.3118, 0.0144, -0.3551, 0.0407, 0.1367, 0.0488, 0.1218, 0.1154,
        -0.1618, 0.3695, 0.1247, 0.0231, -0.1294, -0.0859, 0.2123, 0.0666, -0.0675, 0.0901, -0.0013,
        -0.0341, 0.0427, -0.0103, -0.2722, -0.2072, 0.1117, 0.2007, -0.0400, 0.0623, -0.1420, 0.0354,
        0.2584, 0.1710, -0.1945, 0.0915, -0.1384, -0.0889, -0.0089, 0.0941, -0.0128, -0.0722, -0.0224,
        0.0650, -0.0333, 0.0564, -0.2117, -0.0856, 0.0673, 0.1287, 0.0744, 0.1616, -0.0846, 0.0175,
        -0.0097, 0.1599, -0.2777, 0.1255, 0.1009, 0.1116, 0.2572, -0.0536, 0.0102, 0.0464, 0.2857,
        0.0891, 0.0124, 0.0585, -0.1023, 0.3186, -0.1310, -0.1930, -0.0053, -0.0362, 0.0401, -0.1435,
        -0.1210, 0.0358, -0.0198, -0.0204, 0.0081, 0.0058, 0.1024, 0.2024, -0.0056, -0.0786, 0.1632,
        -0.0059, -0.0123, 0.0766, -0.0457, 0.0753, 0.0605, -0.0838, 0.0168, 0.0288, -0.0687, -0.0291,
        0.1391, 0.0381, -0.0730, 0.1765, 0.1052, -0.1511, -0.0532, 0.1372, 0.0969, 0.0808, 0.0946,
        -0.0390, 0.0586, -0.1223, 0.0966, 0.0121, -0.0189, 0.1570, -0.0466, -0.1023, -0.0223, 0.0729,
        -0.0519, -0.1431, 0.0773, 0.1620, 0.0688, -0.1320, -0.0113, 0.0215, -0.0144, -0.0726, -0.1327,
        0.0135, 0.0012, -0.0175, 0.0069, -0.0704, 0.1094, -0.1058, 0.1533, -0.0305, -0.0299, -0.0355,
        0.1861, -0.2364, 0.0400, -0.0088, 0.0636, 0.2189, 0.0521, -0.0519, 0.0044, -0.0939, -0.0598,
        -0.0817, 0.0325, 0.0844, -0.1311, 0.0261, 0.0201, -0.0387, -0.1449, 0.0158, -0.1771, -0.1642,
        -0.0823, -0.0272, 0.2061, -0.0506, 0.2468, 0.0945, 0.0901, -0.2021, 0.0722, 0.0779, -0.2537,
        -0.0543, 0.1336, -0.0711, 0.0923, -0.0759, 0.0887, 0.0444, 0.1586, -0.1097, -0.2225, 0.1166,
        0.1625, 0.3717, -0.0542, -0.2372, 0.0363, 0.2186, 0.3023, 0.0661, -0.1523, 0.0202, -0.0345,
        -0.0168, -0.1798, 0.0457, 0.0939, -0.2065, 0.0097, 0.0170, -0.0651, 0.0394, 0.0278, -0.2113,
        0.0163, -0.2099, 0.1130, -0.0285, -0.0787, -0.0042, 0.0053, 0.2577, 0.0256, 0.2749, 0.0348,
        0.0704, 0.0820, 0.0469, -0.0173, 0.0635, 0.2849, -0.1074, -0.1524, -0.0168, 0.1011, 0.0372,
        0.0724, 0.0622, -0.0581, -0.0553, 0.0185, -0.2920, 0.0331, 0.0204, 0.0426, -0.0716, 0.1266,
        0.0485, -0.1332, 0.0093, -0.0259, 0.0573, 0.1219, 0.1502, -0.1341, 0.3301, -0.2154, -0.0261,
        0.0322, 0.2632, -0.1911, -0.1887, 0.0962, -0.1333, -0.3868, 0.3512, -0.3739, 0.2210, -0.2619,
        0.2337, 0.0161, 0.0581, -0.3742, 0.4206, -0.1677, 0.0352, -0.2366, 0.2983, 0.2420, 0.0370,
        -0.0831, 0.0343, -0.0773, -0.0813, 0.0786, -0.2909, 0.1515, 0.1038, 0.1381, 0.3440, 0.0606,
        0.0847, -0.1138, -0.1312, 0.0340, -0.0189, -0.2713, 0.0305, -0.2055, -0.1008, 0.0748, 0.1424,
        -0.0334, -0.2530, -0.2566, 0.5658, 0.0077, 0.0512, 0.1058, 0.1610, 0.0948, 0.4108, -0.0599,
        0.0589, 0.1628, -0.0554, 0.1444, -0.3749, -0.1152, -0.1353, -0.3686, 0.2088, 0.1095, 0.0591,
        0.0465, -0.4183, 0.1756, 0.2912, 0.0354, -0.0919, -0.0860, -0.0321, -0.3781, 0.0517, -0.0315,
        0.0825, -0.1355, 0.2541, -0.0530, 0.1034, 0.0215, 0.0550, -0.0151, 0.1005, -0.0452, 0.1035,
        -0.0158, 0.1631, -0.0360, 0.0691, -0.0176, 0.0472, -0.0668, -0.0359, -0.1191, -0.0060, 0.0425,
        0.1457, 0.0497, 0.0216, 0.0793, 0.1895, 0.1281, -0.0607, 0.0959, 0.0102, 0.0093, 0.0586,
        -0.0031, 0.1614, 0.2014, 0.1399, 0.0814, -0.0279, -0.0819, 0.0481, -0.0853, -0.2990, -0.1951,
        -0.0738, -0.0684, -0.0203, -0.0834, -0.0447, 0.0721, 0.0115, -0.2248, 0.0596, 0.0479, -0.1176,
        0.0581, 0.0488, -0.0031, 0.2071, -0.0074, -0.0633, 0.1505, 0.0871, -0.0315, -0.1414, -0.0040,
        0.0466, 0.0039, 0.0514, 0.0567, 0.1361, 0.1007, 0.2148, -0.0998, 0.1278, 0.2251, -0.0292,
        0.0317, -0.2310, -0.0995, 0.0332, -0.0883, 0.1327, 0.1106, 0.0625, 0.0674, -0.2418, 0.1444,
        0.2631, -0.1786, -0.0584, -0.0126, -0.1322, -0.0949, 0.1419, -0.0708, -0.0010, -0.2367, 0.2908,
        0.0599, -0.0263, 0.0962, -0.0845, -0.0674, -0.1450, -0.0172, -0.1116, -0.1448, 0.0960, -0.0037,
        0.1487, 0.1188, -0.0371, 0.0596, -0.0409, -0.0928, 0.0391, 0.0335, 0.0560, -0.1101, -0.0762,
        -0.0011, -0.0517, -0.0519, -0.0463, 0.0162, 0.0241, -0.0697, -0.1249, -0.1540, 0.0773, -0.0110,
        0.0299, 0.0790, 0.0526, -0.0538, -0.1622, 0.0463, -0.0006, -0.2424, 0.1061, 0.0658, 0.1111,
        -0.0190, -0.0257, 0.1165, 0.0302, -0.0662, 0.1253, -0.0383, -0.0221, 0.0066, -0.0821, -0.0734,
        -0.1463, 0.0772, 0.0711, -0.0089, -0.0637, 0.0975, -0.0767, -0.0248, 0.0114, 0.1595, -0.2032,
        0.1508, -0.0538, 0.4263, 0.0945, -0.0307, -0.0494, -0.2376, 0.0187, -0.1040, 0.0266, -0.2685,
        0.2112, -0.0280, 0.3080, 0.2499, 0.6353, -0.3033, 0.0759, -0.1142, 0.0449, -0.3615, -0.0156,
        -0.1188, -0.1144, -0.0078, 0.2889, -0.1724, -0.1663, -0.3356, 0.2387, -0.1929, -0.1333, 0.0848,
        -0.0353, -0.0551, -0.0509, -0.0265, 0.0345, 0.1563, 0.0260, 0.0456, -0.0796, 0.1443, -0.1895,
        -0.0312, 0.1064, 0.0598, 0.0400, -0.0274, -0.0901, 0.0506, -0.0991, -0.0210, 0.0129, -0.1080,
        0.0992, -0.0711, 0.0743, 0.0416, 0.1164, 0.0765, 0.1039, -0.2470, -0.1456, 0.0094, 0.2277,
        0.1506, -0.0911, -0.0049, 0.0447, -0.0013, 0.0879, -0.1522, 0.0293, 0.0483, -0.0084, -0.0737,
        -0.1796, -0.0555, 0.0929, 0.0383, 0.0909, -0.0492, 0.0824, 0.0247, -0.1712, 0.0258, -0.1522,
        -0.0152, -0.0434, 0.0952, 0.1290, -0.0955, 0.0141, 0.0795, 0.2977, -0.0167, 0.1169, -0.3226,
        -0.4870, -0.4005, 0.2059, 0.1658, 0.4838, 0.1721, 0.2135, 0.0751, -0.0114, -0.0269, -0.6504,
        0.2764, 0.2328, 0.1024, -0.1163, -0.2169, -0.0860, 0.1251, 0.0830, -0.1730, -0.1291, 0.1784,
        0.3240, 0.2208, 0.0536, 0.4854, 0.1347, 0.1373, 0.0307, 0.0446, 0.0289, 0.0373, 0.0657,
        -0.0865, -0.0592, 0.1140, 0.0901, 0.0701, 0.0451, -0.0394, -0.0590, -0.0248, 0.0338, 0.0145,
        -0.0314, 0.0113, -0.0533, -0.0683, 0.0945, 0.0755, 0.0732, 0.1522, -0.0504, -0.0057, -0.0583,
        0.1016, 0.0091, 0.0146, -0.0230, 0.0158, -0.0236, -0.0717, 0.0972, -0.0628, 0.0437, 0.0336,
        0.0537, 0.0850, 0.1052, -0.0772, 0.0855, 0.0246, 0.1048, 0.0492, -0.0152, -0.0297, 0.0873,
        0.0206, -0.0905, -0.1518, 0.0330, 0.1326, 0.0351, 0.0697, -0.0790, 0.0265, 0.0618, -0.0232,
        -0.0901, 0.0746, -0.0818, -0.0875, -0.0903, -0.1581, -0.2513, 0.2925, 0.0256, 0.1873, -0.0272,
        -0.3258, -0.0395, -0.1357, 0.1374, 0.0332, -0.1403, 0.1682, 0.1748, -0.0789, 0.0571, -0.3045,
        -0.0912, 0.1419, -0.1668, -0.6793, -0.1021, -0.1545, -0.0745, 0.0291, -0.2573, -0.1244, 0.0064,
        -0.2279, 0.1047, 0.0825, -0.0546, -0.0047, -0.0414, -0.0554, -0.0804, 0.0428, -0.0555, -0.0819,
        -0.0053, 0.0224, 0.0356, 0.0444, -0.0377, -0.0462, -0.0665, 0.0121, 0.0333, -0.1009, -0.1636,
        -0.0506, 0.1425, -0.1625, -0.0411, 0.0237, 0.2264, -0.0385, 0.0043, -0.0122, 0.1170, -0.0474,
        0.1645, -0.0873, 0.1154, -0.1051, -0.4014, 0.0016, -0.1350, -0.4149, 0.1048, -0.0930, 0.2192,
        -0.2221, -0.1091, 0.1314, -0.1612, -0.1533, -0.2464, 0.1881, 0.4901, -0.0792, -0.1774, -0.1154,
        -0.2726, -0.4161, 0.1197, -0.3059, -0.3948, 0.2411, 0.2468, 0.2580, -0.0271, 0.1217, 0.2207,
        0.1055, 0.1145, -0.1403, -0.0359, -0.0302, -0.1355, 0.1558, 0.0066, 0.0567, -0.0617, 0.0388,
        0.0657, 0.0398, -0.0182, 0.1442, 0.0147, 0.1766, 0.0706, 0.1315, -0.1217, 0.0555, -0.0184,
        0.0968, 0.0197, 0.0450, 0.0083, -0.0020, -0.0358, -0.0006, -0.0002, 0.0067, 0.1025, 0.1288,
        -0.0645, -0.0764, -0.0708, 0.1150, -0.1082, 0.0582, 0.0061, -0.0004, 0.0052, 0.0321, -0.0935,
        0.0063, -0.1294, 0.2524, 0.1516, -0.1861, -0.0647, -0.0987, -0.3053, 0.0614, -0.0199, 0.0910,
        -0.1555, -0.0659, 0.1247, 0.0543, -0.0118, -0.0820, 0.0210, 0.0421, -0.0456, -0.1401, 0.0068,
        0.1045, 0.0761, 0.0286, 0.0603, 0.0803, 0.0698, -0.0181, -0.0160, 0.1524, -0.2032, -0.1092,
        -0.0232, -0.3264, 0.1157, -0.2791, -0.0079, -0.0873, 0.1833, 0.0621, 0.1483, -0.1444, -0.0961,
        -0.2814, 0.2234, 0.0717, -0.0684, -0.1133, 0.3205, -0.1670, 0.1449, -0.1915, -0.1177, 0.0984,
        0.2968, 0.2169, 0.4026, 0.2010, -0.0628, 0.1328, -0.0965, -0.1266, -0.3473, -0.1045, 0.0765,
        -0.1603, 0.4938, -0.0452, 0.2060, -0.1289, -0.2430, 0.0980, 0.1556, -0.1805, -0.1857, 0.1422,
        0.0058, -0.1879, 0.1501, -0.1380, 0.1528, -0.5296, 0.1116, -0.0226, -0.0087, -0.0286, 0.0697,
        -0.0681, -0.1843, 0.0787, -0.0350, 0.1519, 0.1596, -0.0190, -0.1334, 0.1177, -0.0413, -0.0204,
        0.0263, -0.0868, -0.0425, 0.0369, -0.0488, -0.0971, 0.0555, 0.1597, 0.1824, -0.0022, 0.0078,
        -0.0748, -0.0918, 0.1803, -0.0939, 0.0125, -0.0913, -0.3815, 0.0233, -0.0339, 0.2131, -0.0184,
        -0.2549, 0.1412, -0.1208, -0.1705, -0.1078, -0.1159, 0.1037, -0.1474, 0.0435, 0.1179, -0.1399,
        -0.0161, 0.1610, 0.0639, 0.1097, -0.2474, -0.1164, -0.0903, -0.1036, 0.0741, 0.2263, 0.1198,
        -0.2109, -0.1500, -0.2947, 0.1779, -0.2369, -0.1577, 0.0834, 0.0460, 0.1644, -0.0690, 0.0420,
        -0.1105, 0.0092, 0.1353, 0.0423, 0.0728, -0.0533, -0.0577, -0.0313, -0.3802, 0.0961, -0.0658,
        -0.0881, -0.0873, -0.0800, -0.0682, 0.1107, 0.0048, -0.0552, -0.0885, -0.1346, 0.0161, 0.1158,
        -0.0050, -0.0525, 0.0035, -0.0020, 0.0146, -0.3320, 0.2487, -0.0329, 0.3972, 0.0544, -0.0048,
        0.0367, -0.3167, 0.0043, -0.1839, 0.0381, -0.1221, -0.4376, -0.0192, 0.2603, 0.2231, -0.0098,
        -0.0948, -0.2907, 0.2846, 0.1789, -0.2296, -0.3222, -0.3749, -0.2353, 0.3987, 0.1051, -0.1008,
        0.2019, -0.4717, 0.2541, -0.0412, -0.0248, 0.0237, -0.1309, 0.0776, 0.0341, 0.0517, 0.1645,
        -0.1786, -0.0776, -0.0442, -0.1637, -0.2068, -0.1461, -0.0284, 0.0997, -0.2105, -0.0156, 0.0244,
        -0.1827, 0.0145, -0.0718, -0.0916, -0.1980, 0.0495, 0.0365, 0.1060, -0.0702, 0.0111, 0.0357,
        -0.0425, 0.0697, 0.3770, -0.0182, 0.0435, -0.2835, -0.0474, 0.1383, 0.0594, -0.0671, 0.4157,
        -0.0005, -0.1792, 0.1025, -0.1011, 0.0852, -0.3362, 0.3479, -0.0371, 0.3145, -0.2082, 0.2918,
        0.0272, -0.2779, -0.1673, 0.2378, 0.1248, 0.0286, -0.1542, 0.0383, 0.0029, 0.1991, -0.0717,
        -0.0583, 0.0023, 0.1604, 0.0598, -0.0549, -0.0322, 0.1070, -0.0814, -0.1179, -0.0786, 0.1548,
        -0.0669, 0.0709, -0.1322, 0.0576, -0.0379, 0.0005, 0.2595, -0.1326, -0.0275, 0.1264, -0.0247,
        0.0224, 0.0756, -0.0359, 0.1514, 0.2133, 0.1221, -0.0578, -0.0200, -0.0362, -0.1703, 0.0189,
        -0.0508, 0.0790, -0.0997, -0.0193, 0.0607, -0.0850, 0.0213, -0.0401, -0.1706, 0.1145, 0.0878,
        0.1136, -0.0600, -0.0640, 0.0303, 0.0880, 0.2390, 0.0072, -0.1035, 0.2293, 0.0697, -0.0231,
        0.0493, -0.1539, 0.1281, -0.0588, 0.0639, -0.0307, 0.0971, -0.0878, 0.0118, -0.1644, -0.0762,
        0.1658, -0.1034, 0.1099, 0.1716, 0.0744, 0.0108, 0.1301, 0.0415, 0.1430, 0.2155, 0.0292,
        -0.0938, -0.2181, 0.0511, -0.0230, -0.4713, -0.0930, 0.0018, 0.0935, -0.0991, 0.0877, 0.2812,
        -0.0506, 0.3615, -0.1529, 0.1606, -0.0293, -0.1074, 0.1261, 0.2088, 0.1843, -0.0373, -0.0360,
        -0.0168, -0.0473, 0.0075, -0.0182, -0.1484, 0.0276, -0.0784, -0.0183, 0.1380, 0.0524, -0.1401,
        -0.1731, -0.1331, -0.0539, 0.0615, -0.0097, -0.0681, -0.1329, -0.0624, 0.0305, -0.0581, -0.1126,
        0.0131, 0.1307, -0.1399, -0.0879, 0.0026, 0.1656, -0.0527, -0.0640, 0.0040, -0.0686, -0.0364,
        -0.0156, 0.0304, -0.0015, 0.0200, -0.0159, 0.0409, -0.0589, -0.0187, -0.1717, -0.0591, 0.0352,
        -0.1125, 0.0126, -0.0900, 0.0378, -0.1234, -0.0866, -0.0435, 0.0814, -0.0437, -0.0915, -0.0179,
        0.0291, -0.0197, 0.0566, 0.0039, -0.0608, -0.0475, 0.0250, 0.3753, 0.5683, 0.0989, -0.2636,
        -0.0406, 0.2259, -0.3330, 0.0426, 0.0870, 0.3615, -0.1101, 0.0627, -0.0767, -0.1412, -0.0608,
        0.0670, -0.0017, -0.0859, 0.2566, -0.0808, -0.1066, -0.0063, -0.1306, 0.0776, -0.5356, -0.0086,
        0.1786, 0.3334, 0.3861, 0.3307, 0.0124, 0.1202, 0.0386, 0.4082, 0.0334, -0.1020, -0.0032,
        -0.0149, -0.3190, -0.0009, 0.1231, 0.2671, -0.0652, -0.0608, -0.0333, -0.0836, 0.0376, -0.0753,
        0.0902, 0.0709, -0.0206, 0.0312, -0.0933, 0.1174, 0.0467, 0.0171, -0.1044, -0.1350, 0.2402,
        0.3143, 0.1752, 0.2389, 0.1360, 0.0979, -0.0258, 0.1670, 0.0507, -0.0772, -0.1388, -0.0135,
        -0.2105, 0.0329, 0.1225, 0.1733, -0.1145, 0.2784, -0.1701, -0.0876, -0.0525, -0.0558, 0.1038,
        0.0186, 0.1305, 0.0328, -0.1259, 0.0669, 0.1490, 0.0207, -0.1772, 0.1055, -0.0268, 0.1791,
        0.1766, 0.2054, 0.2695, -0.0869, 0.0034, -0.1652, -0.0304, 0.0928, 0.0943, -0.1288, 0.0159,
        0.1513, 0.0825, -0.1516, 0.1327, 0.0183, 0.0766, -0.0006, -0.1128, -0.1177, -0.0528, -0.0296,
        -0.0468, 0.0475, -0.1433, 0.0649, 0.1055, 0.0984, 0.1392, -0.0341, -0.0260, -0.1000, 0.0655,
        0.0454, 0.1316, 0.0554, -0.0029, 0.0822, 0.0546, -0.0053, 0.0593, 0.0766, -0.0688, 0.3062,
        0.1440, 0.0205, -0.0638, -0.0062, -0.0370, -0.3060, -0.1397, 0.1062, 0.0471, 0.0620, 0.1061,
        0.0218, -0.1483, 0.1210, -0.0378, -0.1696, -0.0358, -0.1998, 0.1874, -0.0238, 0.2332, -0.0954,
        0.1034, 0.0136, 0.0035, 0.1150, 0.2162, -0.0953, 0.2115, -0.1129, -0.1109, 0.1065, 0.0160,
        -0.0930, -0.0217, -0.1230, 0.0743, -0.1011, 0.0565, -0.0985, -0.3456, 0.0583, 0.2330, -0.0211,
        -0.1291, 0.1341, -0.1702, -0.3223, -0.3033, -0.3748, 0.2809, 0.0569, 0.3526, 0.0068, 0.0791,
        0.0739, 0.0913, 0.5841, -0.0190, 0.0085, -0.1266, -0.0200, -0.1394, -0.2721, 0.1774, 0.3545,
        0.0241, -0.1445, 0.0343, 0.2524, -0.0465, 0.1889, 0.0449, -0.1776, 0.1232, 0.2006, 0.0120,
        0.0345, -0.0009, 0.0397, -0.0186, 0.0713, 0.1500, 0.3416, 0.3649, -0.0614, 0.0972, -0.1404,
        -0.0753, -0.0451, 0.1270, 0.1081, 0.1399, -0.1109, 0.0997, -0.1225, -0.1118, -0.1290, -0.1415,
        0.2206, 0.1661, 0.4379, -0.0266, -0.0482, -0.1053, 0.0562, -0.0630, 0.2077, 0.2928, 0.1281,
        -0.0508, -0.1298, 0.0716, 0.0489, -0.0921, 0.0685, -0.0702, 0.0743, 0.0262, -0.2074, 0.0770,
        0.0822, 0.0872, 0.0753, 0.2767, 0.2475, -0.0897, 0.0212, 0.0684, 0.0791, 0.1915, -0.1433,
        -0.0913, 0.3525, -0.0236, 0.2400, 0.0771, -0.0875, 0.0979, -0.2033, 0.0529, 0.0136, -0.1704,
        0.1850, -0.0808, 0.4413, -0.3286, 0.0100, -0.0677, -0.0302, -0.4838, 0.1550, -0.4341, 0.3756,
        -0.2354, 0.3474, 0.1726, 0.3251, -0.0147, 0.1301, 0.1004, 0.0871, 0.0383, -0.3607, 0.1007,
        0.3848, 0.1970, 0.6660, 0.2100, -0.0789, 0.1152, -0.1393, -0.0463, -0.0885, -0.0706, 0.0236,
        -0.1017, -0.0031, 0.1555, 0.1185, -0.0580, -0.1700, -0.4385, 0.0072, -0.0151, 0.0762, 0.3288,
        0.2028, -0.0513, 0.3176, -0.3891, 0.0593, 0.2729, 0.2336, -0.0200, -0.3784, -0.0922, -0.2408,
        -0.5487, -0.0797, 0.0423, 0.1358, 0.0468, -0.6179, 0.0101, 0.2140, 0.0954, -0.1385, -0.0807,
        0.1238, -0.4198, 0.4614, -0.0155, 0.3530, -0.1761, 0.3637, 0.3052, -0.0780, 0.0100, -0.0395,
        -0.0514, 0.0291, 0.2798, -0.0381, -0.0585, 0.0180, -0.0826, -0.0257, 0.0666, -0.2352, -0.0291,
        0.1822, -0.3363, 0.0505, -0.0495, 0.1016, 0.1048, -0.2267, -0.1073, 0.3137, 0.1999, -0.1156,
        -0.0146, 0.0232, -0.0690, 0.1451, -0.0620, 0.2762, -0.0631, -0.1147, 0.0709, -0.0047, -0.0988,
        0.1406, 0.0589, -0.0927, -0.0344, -0.0029, -0.0292, -0.0080, -0.0746, -0.1888, 0.0471, 0.0908,
        -0.1383, -0.0189, -0.0584, -0.0694, 0.0768, 0.0890, -0.0003, 0.1284, 0.2037, -0.1585, 0.1515,
        0.0797, 0.1389, -0.0787, 0.0028, 0.0361, -0.2527, 0.1614, 0.1896, 0.3510, 0.0464, 0.3890,
        -0.2336, 0.1244, 0.2633, 0.1481, -0.1247, -0.3575, 0.0471, 0.0619, -0.2209, 0.3404, 0.0411,
        0.0464, 0.0590, -0.4025, -0.0603, 0.0779, 0.0257, -0.0886, 0.1202, 0.1351, -0.1549, 0.2307,
        -0.0818, 0.0850, -0.3010, 0.0119, 0.1516, -0.0436, -0.0239, -0.0894, 0.1590, -0.0303, 0.1886,
        -0.0211, -0.1137, 0.1560, 0.0261, 0.1876, -0.0873, 0.0190, 0.1263, 0.1438, 0.1118, -0.0568,
        -0.1324, -0.1774, 0.0856, -0.0795, -0.1271, -0.1188, 0.0091, 0.1575, 0.0143, -0.0428, 0.1025,
        -0.0565, 0.0254, 0.1297, 0.1669, -0.0126, 0.0138, 0.0238, 0.1923, 0.0281, 0.0981, -0.0360,
        -0.0956, 0.0421, -0.0087, 0.1562, -0.0102, -0.0740, 0.0238, 0.1635, 0.0827, 0.0627, -0.0648,
        -0.1031, 0.0898, -0.0746, -0.2876, -0.0702, 0.0466, 0.1650, -0.0441, -0.1503, 0.0581, 0.0052,
        -0.0287, 0.0309, -0.1410, 0.2351, 0.0956, 0.1339, 0.2308, 0.1355, 0.2636, -0.0350, -0.0690,
        -0.1678, -0.2410, -0.0529, -0.0333, -0.2018, 0.1971, 0.0018, 0.4890, 0.0671, 0.4362, 0.0853,
        -0.1113, 0.2616, 0.0039, 0.1598, 0.5000, 0.0793, 0.2610, -0.2975, -0.3070, -0.3103, -0.1939,
        -0.2134, -0.1786, -0.1366, 0.1049, -0.0383, -0.1214, -0.1153, -0.0238, 0.0398, 0.0391, 0.1296,
        -0.0765, 0.1576, 0.3100, -0.1442, -0.0069, 0.1366, 0.1717, 0.0154, -0.0098, 0.0605, 0.1629,
        0.0234, 0.0478, -0.0796, -0.0035, 0.2050, 0.1219, -0.0162, 0.1309, -0.0225, -0.0318, 0.0825,
        -0.0922, -0.4074, 0.0008, 0.1495, 0.3412, 0.0607, 0.2001, 0.0010, -0.1634, -0.3391, 0.1428,
        -0.1644, -0.2207, 0.0955, -0.0235, 0.2506, -0.2249, -0.0516, -0.3107, -0.0774, 0.3277, 0.1249,
        -0.1657, -0.1772, 0.0997, 0.1777, -0.2631, -0.3471, -0.3071, -0.1578, -0.2672, 0.0216, -0.0594,
        -0.4552, 0.0135, -0.0262, 0.0028, -0.0677, 0.6183, 0.0894, -0.0754, -0.5528, 0.2134, -0.0154,
        -0.3668, -0.0366, 0.0090, 0.0644, -0.0628, -0.0130, -0.3472, -0.0318, 0.4663, 0.1404, -0.2719,
        0.1368, 0.0661, 0.3134, -0.3843, -0.2567, -0.3935, -0.1409, -0.1946, 0.2824, -0.0986, -0.1165,
        0.1661, -0.0852, -0.1122, -0.0224, -0.0675, 0.0082, 0.0020, -0.0690, 0.0258, -0.0153, -0.0347,
        -0.0332, -0.0245, -0.0679, -0.0933, -0.0855, -0.0218, -0.1393, 0.0357, 0.0763, -0.0138, 0.0263,
        -0.0668, 0.0571, -0.0661, 0.0978, -0.1306, -0.0353, -0.1120, -0.0424, -0.0805, -0.0062, 0.0847,
        -0.1241, -0.1075, 0.0699, 0.0631, 0.0348, -0.1154, -0.1250, 0.0159, -0.2505, 0.0525, 0.0772,
        -0.1011, 0.0032, -0.0215, -0.2011, -0.1359, -0.1359, 0.1229, -0.0600, -0.0124, 0.0150, 0.0155,
        0.2297, -0.0986, 0.1886, -0.1934, 0.0150, -0.1624, 0.0897, -0.5155, 0.3082, 0.1586, 0.6167,
        0.3019, -0.1878, 0.1759, -0.1698, -0.1290, 0.6118, 0.1337, 0.3256, 0.0453, 0.0162, 0.2826,
        -0.0023, -0.0389, -0.3137, 0.5465, 0.2667, 0.1502, 0.5188, -0.3534, -0.4947, 0.3236, -0.0550,
        0.1211, -0.2744, -0.1652, -0.4586, 0.1655, -0.5628, -0.0464, 0.0766, -0.2808, 0.2533, 0.0455,
        -0.0563, -0.0306, -0.1954, 0.1683, 0.1672, 0.0796, 0.1443, -0.0110, 0.1302, -0.1001, 0.0078,
        -0.0032, -0.0203, 0.0949, 0.0792, -0.1020, 0.3244, -0.0454, 0.1172, 0.1070, -0.0809, -0.1037,
        0.0070, 0.1262, -0.1320, 0.0351, -0.1520, -0.3324, 0.0219, 0.1645, 0.1675, 0.1421, -0.2219,
        0.0288, -0.1336, -0.0263, 0.3469, -0.0401, -0.0027, 0.0000, 0.1227, 0.1933, -0.1260, 0.0674,
        0.1359, 0.2838, 0.1007, 0.0765, 0.2903, -0.3545, -0.2842, 0.0474, -0.0233, 0.0690, -0.2171,
        0.0851, -0.3021, -0.1006, -0.0975, 0.0390, 0.1017, -0.1356, 0.1347, 0.0342, -0.0453, 0.0524,
        -0.0873, 0.1205, -0.0702, 0.1589, 0.1043, -0.0477, 0.0746, 0.0214, 0.1606, -0.1340, -0.1239,
        -0.0305, 0.0944, -0.0750, 0.0543, 0.1145, 0.0679, 0.0504, -0.0521, 0.0133, -0.2082, 0.0427,
        -0.2253, 0.1015, -0.1239, 0.0765, -0.0049, 0.1414, -0.2246, -0.0303, 0.0679, 0.0318, 0.0671,
        0.0751, -0.0231, 0.0947, -0.0014, -0.0273, -0.0117, 0.1677, -0.0663, -0.2198, 0.2321, -0.0289,
        -0.2987, 0.0508, -0.0858, 0.1205, -0.2080, -0.0896, 0.1249, 0.0508, 0.0450, 0.2226, -0.0059,
        0.1377, 0.0351, -0.1390, 0.3332, 0.1337, -0.0156, -0.1178, 0.1695, -0.5781, 0.1068, 0.3982,
        0.4142, -0.1194, -0.3703, 0.0789, -0.1514, -0.3161, 0.0660, -0.0587, -0.1341, 0.3266, -0.1316,
        -0.1845, 0.0052, -0.0287, -0.1266, -0.3175, -0.1920, 0.2751, 0.0884, 0.3143, 0.0301, -0.2171,
        0.0237, -0.2968, 0.2758, 0.1557, 0.3024, 0.0374, 0.3982, -0.3698, 0.1215, 0.2509, 0.3095,
        -0.1306, -0.4391, 0.1036, 0.1365, -0.2134, 0.2453, 0.2203, -0.0305, 0.0922, -0.4297, -0.0851,
        -0.0075, 0.0678, 0.0166, 0.0650, 0.1898, -0.1788, 0.3664, -0.0304, 0.1454, -0.2600, 0.0405,
        0.2337, -0.0593, 0.1264, -0.1492, 0.1629, 0.0610, 0.1290, -0.1529, -0.0515, 0.0417, -0.0471,
        -0.0575, 0.2447, -0.0729, -0.1117, 0.0220, -0.0140, 0.0199, -0.0338, -0.1807, 0.0971, 0.0392,
        -0.0573, -0.0330, -0.1033, 0.1053, 0.1141, -0.1503, 0.2294, 0.2252, -0.0221, 0.1608, -0.2796,
        0.0651, 0.0697, 0.0837, 0.1652, -0.0668, 0.1985, -0.1935, -0.0068, 0.0396, -0.4628, -0.1702,
        0.0122, 0.1563, 0.0855, 0.1917, 0.0475, 0.2625, -0.0139, -0.0481, -0.0366, 0.1200, -0.4089,
        -0.3218, -0.2195, 0.2403, 0.0106, -0.2777, -0.0880, -0.3350, -0.3386, -0.1133, -0.2320, 0.0365,
        -0.0346, 0.0545, -0.1756, 0.1207, -0.0148, -0.0571, 0.1258, -0.0912, -0.0228, -0.1065, -0.0633,
        0.2498, -0.4082, -0.0884, -0.2115, -0.2121, -0.1979, 0.2387, 0.0441, 0.1717, -0.0304, 0.0019,
        -0.0108, -0.1140, -0.1270, 0.0429, -0.0879, 0.0273, -0.0254, 0.0905, -0.0137, -0.2323, 0.2173,
        -0.1980, 0.4634, 0.1897, -0.0570, 0.1357, -0.2506, 0.1363, -0.1232, -0.0904, -0.1054, -0.4015,
        -0.1649, 0.3474, 0.2577, 0.0034, -0.0287, -0.2047, 0.3495, 0.1590, -0.1939, -0.2960, -0.4053,
        -0.3470, 0.3762, 0.0030, -0.2638, 0.2024, -0.3833, 0.3439, 0.0339, -0.0568, 0.0289, -0.0266,
        -0.0484, 0.0556, 0.0878, 0.1902, -0.0840, -0.0351, -0.0116, -0.0932, -0.2605, -0.2022, -0.2039,
        -0.0087, -0.0851, 0.0288, 0.0660, -0.2892, 0.1138, -0.1142, -0.0360, -0.2413, -0.1271, 0.0386,
        0.0928, 0.1550, 0.0256, 0.0354, -0.1090, 0.1115, 0.3931, -0.0192, 0.0513, -0.2445, 0.1355,
        0.1418, -0.1088, -0.0135, 0.3686, 0.2376, -0.3734, 0.1741, -0.1086, 0.2290, -0.2893, 0.2325,
        -0.0165, 0.3728, -0.0584, 0.2603, -0.0622, -0.2131, 0.0215, 0.2092, 0.2352, 0.2058, 0.0308,
        0.2538, 0.2195, 0.4488, -0.1631, -0.2482, -0.0325, 0.3244, -0.0451, 0.1470, 0.1680, 0.0798,
        0.0594, -0.0042, -0.0068, 0.0880, -0.0778, -0.0537, -0.1210, 0.1440, 0.1416, -0.0092, 0.0958,
        -0.0080, 0.1367, 0.1874, -0.0011, 0.1001, -0.0505, -0.1107, -0.0374, -0.0249, 0.0123, -0.1169,
        0.0427, -0.0150, -0.2513, -0.1447, 0.0991, 0.0609, -0.1979, -0.0988, 0.0356, -0.3252, -0.1497,
        0.0752, -0.0187, 0.3772, -0.1139, 0.1353, -0.0237, -0.1480, -0.0233, -0.1906, 0.4076, 0.0732,
        0.1052, -0.0850, 0.0217, -0.1872, 0.0624, -0.1286, 0.0467, -0.1969, 0.0805, -0.0263, 0.2742,
        0.1268, 0.3752, -0.1088, -0.0402, -0.1726, -0.1967, -0.0973, -0.0730, -0.2395, 0.1078, 0.1548,
        -0.0120, -0.0040, 0.3443, 0.4231, -0.1214, -0.2220, -0.0798, -0.0951, -0.7036, -0.3395, -0.1923,
        0.3322, 0.2281, -0.1003, 0.0547, 0.2083, 0.1680, -0.3142, 0.1822, 0.0718, -0.1659, -0.0084,
        0.0530, 0.0034, -0.0284, 0.1296, -0.0946, 0.0825, 0.0199, -0.0272, 0.0127, -0.0627, 0.0546,
        -0.0416, -0.0636, -0.1585, -0.0620, -0.0471, 0.0615, 0.0400, 0.0285, 0.0596, 0.0224, 0.0601,
        -0.0987, 0.0061, -0.1221, -0.0005, 0.1544, 0.0336, 0.1418, -0.0157, 0.0270, -0.1582, 0.0561,
        -0.0862, 0.0992, 0.0966, -0.0792, 0.1431, 0.1446, -0.0372, -0.1048, -0.1102, 0.0760, -0.0547,
        -0.0801, -0.1377, -0.0005, 0.0344, 0.0967, 0.0707, -0.0693, 0.0196, 0.0911, 0.1461, 0.0565,
        0.0625, -0.0966, 0.1575, 0.1230, -0.0768, 0.1338, -0.0578, -0.0101, -0.1601, 0.1626, 0.0559,
        -0.0524, -0.0156, -0.2021, 0.3105, 0.3152, 0.1150, 0.2725, -0.0835, -0.1622, -0.1203, 0.7748,
        -0.5267, -0.3480, -0.0893, -0.2846, 0.3376, 0.1209, -0.3151, 0.4396, -0.1748, 0.6471, 0.5238,
        -0.0870, -0.1150, -0.0928, 0.3092, -0.4969, -0.3645, -0.0204, -0.8990, -0.0761, 0.4037, -0.0142,
        0.0742, 0.2008, -0.0879, 0.0552, 0.0060, -0.1079, 0.1044, 0.0842, 0.1314, -0.0499, 0.0121,
        -0.3190, -0.1396, 0.0623, 0.0902, -0.0837, -0.0165, -0.0297, 0.0202, -0.1356, 0.0955, -0.2395,
        -0.2766, -0.6045, -0.1450, 0.2318, 0.2857, -0.1640, 0.2208, -0.1671, 0.0176, 0.1917, -0.1900,
        0.2179, -0.0282, 0.3490, 0.0473, 0.2248, 0.1825, -0.2533, -0.0451, 0.1926, -0.2230, -0.3270,
        -0.1639, -0.1196, 0.2718, 0.1872, 0.1576, 0.2600, 0.2870, 0.7141, 0.0568, 0.0132, 0.2325,
        -0.2375, 0.1219, -0.2052, -0.0292, -0.0236, -0.4373, 0.0494, -0.1149, 0.0089, -0.0095, 0.2235,
        -0.2298, 0.0729, 0.2354, 0.0618, 0.1212, 0.2628, 0.1888, -0.2262, 0.3146, -0.0739, -0.1206,
        -0.0369, -0.0643, 0.1927, 0.0393, 0.1087, 0.3002, 0.3078, -0.0386, 0.1688, 0.1796, -0.0703,
        0.1114, 0.4342, -0.2543, 0.1665, 0.1743, 0.3581, -0.1283, 0.0513, 0.1743, 0.3916, -0.2458,
        0.2980, 0.2010, -0.3331, 0.1305, 0.3234, 0.2027, -0.2454, 0.1383, -0.0172, 0.0324, -0.0824,
        -0.1792, 0.3679, 0.0360, 0.2825, 0.0053, 0.2252, -0.1702, 0.4619, -0.0077, -0.0953, -0.1725,
        0.3700, -0.0417, 0.5384, 0.1716, 0.1575, 0.0497, 0.1664, 0.0467, 0.1307, -0.0889, -0.0102,
        -0.4060, 0.1768, 0.1078, -0.1398, 0.0085, 0.1220, 0.1173, -0.0091, -0.0180, -0.0318, 0.0600,
        -0.0971, 0.1630, -0.0522, -0.0873, 0.0395, -0.0372, 0.1615, -0.1709, 0.1526, 0.5299, 0.2667,
        -0.0809, 0.2181, 0.1846, 0.1857, 0.0011, 0.2138, 0.0117, 0.3476, -0.1920, 0.0948, -0.1920,
        0.2539, 0.1397, -0.3433, -0.0881, 0.0654, 0.0658, 0.0837, -0.1736, -0.0409, 0.3380, -0.0002,
        0.1114, -0.0314, -0.1821, 0.1743, -0.0769, 0.1315, -0.0842, 0.0879, 0.5172, 0.1489, -0.0382,
        0.3814, 0.1431, 0.3227, -0.0271, 0.1625, -0.0033, 0.2133, -0.0452, 0.1106, -0.0381, 0.2155,
        0.1828, -0.1225, -0.0107, 0.1725, -0.0124, 0.2072, -0.1112, 0.1502, 0.3253, -0.1041, 0.0978,
        0.0913, 0.0572, -0.1324, 0.0542, -0.0492, -0.3309, -0.0011, 0.3429, 0.1471, -0.0628, 0.1932,
        0.1536, -0.0507, -0.0833, 0.1429, 0.0721, -0.1326, -0.1316, -0.3482, -0.0694, -0.0653, -0.0722,
        0.0123, 0.0249, 0.0217, 0.0756, -0.0468, -0.0416, 0.0027, -0.1081, -0.1065, 0.1147, 0.2502,
        0.0072, 0.0516, -0.0191, -0.0207, -0.0519, -0.0726, -0.0404, 0.3019, 0.0434, -0.0349, -0.0061,
        -0.1046, 0.0630, 0.0625, 0.0290, 0.0078, -0.1033, -0.3245, -0.0254, -0.0747, -0.0471, 0.0037,
        -0.0015, 0.0901, 0.0585, 0.0255, -0.0268, -0.0246, -0.1083, 0.0103, 0.0286, 0.1614, -0.0044,
        0.0106, -0.0272, -0.0003, -0.0330, 0.0043, -0.0658, 0.2225, 0.0463, -0.0477, -0.0077, -0.0353,
        0.1125, 0.2802, 0.1976, -0.1907, -0.2452, -0.4514, 0.0468, -0.2163, 0.0718, 0.0938, 0.1389,
        0.1802, 0.0296, 0.0918, -0.1831, -0.0781, 0.0234, 0.1144, -0.0250, 0.3255, -0.0917, -0.0930,
        -0.1745, -0.1906, 0.1335, -0.1133, -0.1358, 0.3385, -0.1723, 0.1339, -0.1747, -0.1834, 0.2414,
        0.0425, 0.2457, -0.0633, -0.1186, -0.4433, -0.0799, -0.0270, -0.0726, 0.0886, 0.1156, 0.0059,
        0.0716, 0.0628, -0.0507, 0.0336, -0.1116, 0.0522, 0.0841, 0.1672, -0.0286, -0.0347, -0.1387,
        0.0610, -0.0060, 0.0686, 0.0148, 0.1287, -0.0230, -0.0217, -0.0391, 0.0055, -0.0507, 0.1473,
        0.0170, -0.0324, -0.3461, -0.8403, -0.0138, -0.0406, -0.0857, -0.0078, -0.0377, -0.0666, -0.0532,
        0.2650, -0.0429, -0.0665, -0.3442, -0.0923, 0.1651, 0.1415, -0.0717, 0.1310, -0.0566, 0.1180,
        0.0668, 0.0201, -0.0470, 0.4090, 0.0940, -0.2238, -0.1010, -0.0001, 0.1384, 0.1064, 0.0981,
        -0.0172, -0.0312, -0.3977, -0.0284, 0.0011, -0.0069, 0.0909, 0.0587, 0.0902, 0.0259, 0.0193,
        -0.0263, -0.0501, -0.0743, 0.0038, 0.0708, 0.1972, 0.0336, -0.0400, -0.0490, 0.0759, -0.0145,
        0.0272, -0.0331, 0.1677, 0.0491, 0.0585, 0.0231, -0.0776, 0.1335, 0.1112, -0.1262, -0.0514,
        -0.1153, -0.0930, 0.2367, 0.0610, 0.1362, 0.0663, -0.0700, -0.0198, -0.0805, 0.1215, -0.0376,
        0.0199, 0.2474, 0.0991, -0.0678, 0.1418, 0.0247, 0.0338, -0.0695, -0.3195, -0.0588, -0.1096,
        0.0090, 0.0617, -0.1819, -0.3176, -0.0261, -0.3524, -0.0287, 0.1536, -0.0407, 0.0183, 0.0285,
        -0.2428, 0.1415, 0.0642, 0.1327, -0.0298, -0.0157, 0.0068, -0.0203, 0.0586, 0.0230, -0.0541,
        0.1102, -0.0229, 0.0565, 0.2093, 0.1236, 0.0240, -0.0313, -0.2108, 0.0829, -0.0612, 0.0043,
        0.0363, 0.1217, -0.1717, 0.0015, -0.2415, -0.0025, 0.1497, 0.1036, 0.1270, -0.1956, -1.0666,
        -0.0495, -0.0990, 0.0087, 0.0294, -0.0150, -0.2331, -0.0712, 0.3944, -0.0540, -0.1023, -0.0720,
        -0.1158, -0.1613, 0.2705, -0.0869, 0.2340, -0.0148, 0.1976, 0.0926, 0.0764, -0.0714, 0.3476,
        0.2354, -0.3173, 0.0604, 0.1069, -0.1117, 0.0489, -0.2461, 0.1382, 0.0498, 0.0734, 0.2606,
        -0.0656, 0.0841, -0.1622, -0.0495, -0.0238, 0.0245, -0.0556, -0.0958, -0.0246, 0.1007, 0.0355,
        0.0648, 0.1458, 0.1521, 0.1736, -0.1066, -0.1406, -0.0623, -0.0300, 0.3195, 0.1564, 0.0716,
        -0.0547, 0.0329, -0.0295, -0.0777, 0.0929, 0.0214, 0.0088, -0.0531, -0.1703, 0.0459, -0.1071,
        0.0781, 0.1520, -0.0291, 0.1539, 0.0206, 0.1011, -0.1017, -0.1321, 0.0472, 0.0789, -0.0562,
        -0.0384, -0.0554, 0.1524, 0.0717, -0.0181, 0.0654, -0.0311, -0.1185, -0.0146, -0.0210, 0.0791,
        -0.0731, -0.0145, 0.1784, -0.2100, 0.0970, 0.4245, -0.0068, 0.0991, -0.1254, -0.0336, -0.1799,
        0.0851, -0.0485, -0.2346, 0.0400, -0.1960, 0.1792, 0.1395, -0.1821, -0.0217, 0.0242, -0.0352,
        0.0773, 0.2475, 0.1080, 0.3521, -0.2216, 0.0137, 0.1768, 0.1614, 0.1421, 0.1823, 0.0716,
        0.4363, -0.3002, -0.0206, 0.0676, 0.2545, -0.0560, 0.0155, -0.0186, -0.0839, 0.0127, 0.1609,
        0.0220, -0.2004, 0.0287, -0.1283, 0.0796, 0.0888, -0.0380, 0.1184, 0.0374, 0.0369, 0.0766,
        0.1191, 0.0248, 0.1532, -0.0433, -0.0715, 0.0601, 0.2268, -0.0977, 0.1855, -0.0619, 0.2099,
        -0.1489, 0.1201, 0.0363, 0.0040, 0.0426, -0.0462, -0.0124, 0.0980, 0.0305, -0.0286, 0.0730,
        -0.0794, 0.0349, -0.0776, -0.0152, 0.1190, -0.0085, -0.0217, 0.1163, 0.0646, -0.0365, 0.1573,
        -0.0836, 0.0156, -0.1003, 0.0976, 0.1351, 0.2120, 0.1261, -0.0529, 0.0081, -0.0758, -0.0292,
        -0.0464, -0.0641, 0.2001, 0.0610, 0.0360, 0.0371, 0.1544, -0.0211, -0.0828, 0.0411, -0.0964,
        -0.0303, 0.0014, 0.0334, 0.2109, -0.0231, 0.0110, 0.0640, 0.0099, 0.0232, 0.1665, -0.1117,
        0.0327, -0.1347, 0.1191, 0.1031, 0.0934, 0.1537, -0.1046, 0.0593, 0.0489, -0.1571, -0.0842,
        0.0205, 0.2621, 0.2209, 0.2970, -0.0617, 0.1325, -0.0036, -0.0668, -0.1576, 0.0623, -0.0019,
        0.0358, 0.0640, 0.1000, 0.0494, -0.1677, -0.1325, 0.0762, 0.0087, 0.0869, 0.0570, 0.1490,
        -0.0380, 0.0294, 0.0241, -0.0006, 0.0403, -0.0692, -0.2267, 0.0890, -0.3218, -0.0440, -0.1190,
        -0.0090, 0.0474, 0.0949, -0.0308, 0.0896, -0.1006, -0.1224, -0.1257, -0.0592, 0.0679, -0.2622,
        0.0813, 0.0590, 0.0667, -0.1203, 0.1261, 0.0372, 0.0476, 0.1164, 0.0629, -0.0913, -0.0760,
        -0.0790, 0.0266, 0.0688, 0.0602, -0.1067, 0.0416, -0.0871, -0.0664, -0.0687, -0.1382, 0.0503,
        0.0355, 0.0748, -0.0053, 0.0384, -0.0926, -0.0584, -0.0922, 0.0244, 0.0618, -0.1548, -0.0097,
        0.0321, 0.0067, -0.0041, 0.0284, 0.0375, 0.0393, 0.0424, 0.0407, -0.0716, -0.1059, -0.0705,
        -0.0233, 0.0405, 0.0615, -0.0478, 0.0197, -0.0105, -0.0024, 0.0262, -0.0743, -0.0792, -0.0754,
        0.0007, 0.0685, -0.0003, -0.0080, -0.0740, -0.0700, 0.0333, 0.0250, -0.1451, -0.0365, -0.0066,
        0.2035, 0.0365, 0.0408, 0.0486, -0.0197, 0.0868, -0.0682, -0.2363, 0.0470, -0.0889, -0.0481,
        0.0813, -0.0902, -0.0021, -0.0655, -0.1400, 0.0427, -0.0720, 0.1530, -0.0285, 0.0221, 0.0492,
        -0.0923, 0.0783, -0.0898, 0.0622, 0.0615, -0.0125, 0.0756, -0.0981, -0.0328, 0.0566, 0.0172,
        0.1093, 0.0212, 0.0188, -0.0552, -0.0639, -0.1153, -0.0203, -0.0144, -0.0043, 0.0623, -0.1083,
        -0.0309, 0.0020, -0.0133, -0.0047, -0.1620, -0.1044, -0.0586, 0.0403, 0.2513, 0.1844, -0.0131,
        0.0728, -0.0178, -0.0724, 0.0178, 0.0293, -0.0651, -0.1784, 0.1207, -0.0370, 0.0251, -0.0588,
        0.0741, -0.0114, 0.0354, 0.0288, 0.0298, 0.0115, -0.0367, -0.0437, -0.0112, -0.2014, 0.2457,
        0.0031, 0.0218, -0.0640, -0.1058, -0.0633, 0.1428, 0.0616, 0.3519, 0.1743, -0.0983, -0.0682,
        0.0395, 0.1746, 0.2024, 0.1161, 0.1053, -0.0809, -0.0720, -0.0137, -0.0616, 0.1188, 0.0090,
        0.1847, 0.0446, -0.0976, -0.0020, 0.2099, -0.0187, 0.0451, 0.0325, 0.0393, 0.0104, 0.1631,
        0.0852, 0.0692, 0.1054, -0.0095, -0.1329, 0.1280, -0.1450, -0.1646, 0.0843, 0.1364, 0.0077,
        -0.1194, -0.1066, -0.1419, -0.0758, 0.0147, 0.0776, 0.0910, 0.1359, -0.0645, -0.0054, -0.0392,
        -0.0797, 0.2028, 0.0311, -0.2975, -0.0010, -0.0901, 0.0771, 0.1102, 0.1736, -0.3342, 0.0707,
        -0.2221, -0.1220, 0.0284, -0.0738, 0.1176, 0.0679, -0.0197, 0.1160, 0.0720, 0.1619, -0.0171,
        0.0141, -0.0221, -0.0024, -0.0043, 0.0053, 0.0356, 0.0999, 0.0571, 0.0594, 0.0953, -0.0157,
        -0.0036, -0.0962, -0.2450, 0.0780, -0.0493, 0.0764, 0.0378, 0.0713, -0.1529, 0.0393, -0.2259,
        0.0181, -0.1185, -0.0787, 0.3237, 0.2882, -0.0820, -0.2388, 0.0579, 0.0301, -0.0245, -0.0476,
        -0.1344, 0.1297, -0.0225, 0.1398, 0.0698, -0.1897, -0.0904, -0.0742, -0.0094, 0.0541, 0.1233,
        0.0763, 0.1832, 0.0090, 0.1499, 0.1644, -0.0681, 0.3165, -0.2111, 0.1956, 0.2201, -0.2616,
        0.0593, -0.2324, 0.1168, 0.0375, 0.0503, 0.2643, -0.0724, 0.0739, -0.1498, -0.0439, -0.0201,
        0.0177, -0.0273, -0.0985, -0.0233, 0.1422, 0.0462, 0.0528, 0.1248, 0.1448, 0.1534, -0.1450,
        -0.1613, -0.0459, -0.0395, 0.3259, 0.1699, 0.0661, -0.0075, 0.0083, -0.0542, -0.0516, -0.0007,
        -0.0606, 0.0481, 0.0282, 0.1591, 0.0587, -0.0709, 0.0559, 0.1178, -0.0354, 0.1061, -0.0395,
        -0.0722, -0.0786, -0.1373, 0.1761, 0.0468, -0.1178, -0.1840, -0.0377, 0.1699, 0.1632, -0.0696,
        0.0557, -0.0459, -0.1101, -0.2038, -0.0923, 0.0952, -0.0451, -0.0050, 0.1011, -0.0591, 0.2118,
        0.1932, 0.0262, -0.0650, -0.1421, -0.1784, -0.0695, 0.2123, 0.0573, 0.0479, 0.0451, -0.0373,
        0.1094, 0.0557, -0.3274, 0.0156, -0.0468, 0.1633, 0.0332, 0.0275, -0.0069, 0.3091, -0.0875,
        -0.0905, 0.0500, 0.1991, 0.0283, 0.2633, -0.0374, 0.3080, -0.0134, 0.0591, 0.1379, 0.1483,
        0.0409, -0.0903, -0.0363, -0.1265, 0.0694, 0.1770, 0.0291, 0.0029, 0.0706, -0.0669, 0.0945,
        0.1049, -0.1565, 0.0708, 0.0159, 0.1187, 0.0925, -0.0032, 0.0263, 0.1557, 0.0145, -0.0890,
        -0.0216, 0.1980, -0.1491, 0.1966, -0.1096, 0.1249, -0.0107, 0.0473, 0.0083, 0.1108, 0.0161,
        0.0782, 0.0219, 0.0997, -0.0430, -0.0388, 0.0624, -0.0538, 0.0090, -0.0838, 0.0529, 0.0945,
        0.0393, 0.0010, 0.0604, 0.0115, -0.0528, 0.1458, -0.0577, -0.0357, -0.1008, 0.0822, 0.1345,
        0.2018, 0.0786, -0.0199, -0.0056, -0.0520, -0.0590, -0.0223, 0.0127, 0.1841, -0.0077, 0.0125,
        0.0336, 0.0903, -0.0633, -0.0332, 0.0782, -0.0048, -0.0358, 0.0208, -0.0096, 0.1442, -0.0211,
        0.0490, -0.0168, 0.0533, -0.0409, 0.0884, -0.1169, -0.0458, -0.1277, 0.0510, 0.0670, 0.1634,
        0.0956, 0.0397, -0.0066, 0.0481, -0.0698, 0.0333, 0.1562, 0.2987, 0.0424, -0.0407, -0.1394,
        0.0203, 0.0472, 0.0050, -0.1342, 0.0904, 0.0034, 0.1519, -0.0289, 0.0055, -0.1864, -0.2006,
        -0.1360, 0.2080, -0.1327, 0.0912, -0.0369, 0.2255, 0.0325, 0.0512, -0.0190, 0.2331, 0.0936,
        -0.0417, -0.2782, 0.0724, -0.0926, -0.0866, 0.1010, 0.0675, 0.0610, 0.0283, 0.0029, -0.1309,
        -0.1148, 0.0001, 0.0660, -0.0085, -0.0117, -0.1457, 0.1205, 0.0072, -0.1068, -0.0601, 0.1139,
        0.2844, 0.0129, -0.0132, 0.1310, -0.0118, -0.0884, -0.1244, -0.0919, 0.3010, 0.1189, 0.0037,
        -0.0281, 0.0252, 0.0240, -0.0657, 0.0893, 0.0791, 0.0238, 0.0248, -0.0071, -0.1329, -0.1175,
        0.0532, 0.0610, 0.0892, -0.0032, -0.0460, 0.0296, -0.0224, -0.1533, -0.0129, -0.0185, 0.2341,
        0.0176, -0.0489, 0.0810, -0.0271, -0.1605, -0.0810, -0.1332, 0.2777, 0.1317, 0.0047, -0.0549,
        0.0886, 0.0754, -0.0120, 0.1091, 0.0228, -0.0375, 0.0078, 0.1008, -0.1179, -0.0220, 0.0495,
        0.0674, 0.0643, -0.0345, -0.0369, 0.0086, -0.0454, 0.0763, 0.0784, 0.0147, 0.3059, -0.0234,
        -0.0268, 0.0187, -0.1761, 0.0218, -0.0732, -0.1311, 0.3104, -0.0489, 0.0672, -0.1299, -0.0252,
        0.0810, -0.1226, 0.4412, 0.0095, 0.0310, 0.0004, -0.0826, -0.0961, -0.0677, 0.1823, 0.2646,
        0.0981, 0.0103, 0.0599, 0.0173, -0.0081, -0.1911, 0.1216, 0.0132, 0.3048, -0.1673, -0.1929,
        -0.0643, 0.0631, 0.0480, -0.0237, -0.0845, 0.1819, 0.0723, 0.0964, -0.0964, 0.1370, -0.0256,
        -0.0824, -0.2177, -0.0016, 0.1244, 0.1148, 0.0438, 0.2006, 0.0263, -0.0707, -0.0465, 0.0001,
        -0.0838, -0.1299, 0.0847, -0.0670, 0.0870, -0.0291, 0.1001, -0.2092, -0.0815, 0.1324, -0.0244,
        -0.1259, 0.0064, -0.1318, 0.0684, -0.2752, 0.0941, -0.1538, 0.0793, -0.1178, -0.0965, -0.0902,
        -0.2467, 0.0642, 0.0697, 0.0295, 0.0189, 0.1917, -0.0264, -0.0181, -0.1647, -0.0118, -0.0285,
        -0.0459, 0.0161, -0.0328, 0.0158, 0.0108, 0.0373, -0.2433, -0.1107, 0.1699, -0.0160, -0.0539,
        -0.0567, -0.0609, 0.1411, -0.1532, -0.0135, -0.2253, 0.0899, -0.0571, 0.0024, -0.0548, 0.1904,
        0.1752, 0.1173, -0.0897, 0.0184, 0.0082, 0.0871, 0.0117, 0.1628, -0.0571, -0.0323, 0.0623,
        0.0003, 0.1070, -0.0269, 0.0386, 0.0930, 0.2453, -0.0717, 0.0259, 0.0370, -0.0718, -0.0849,
        0.0064, -0.0373, 0.3101, 0.2804, -0.1100, -0.1005, -0.0238, -0.0114, 0.0248, -0.0212, 0.1526,
        0.0563, -0.0810, 0.1815, 0.0255, 0.1819, 0.0468, 0.0756, -0.0334, -0.0545, 0.0807, -0.0274,
        0.0223, 0.1396, 0.0584, 0.1180, 0.1347, -0.0617, 0.0412, -0.0930, -0.2588, 0.0059, -0.0570,
        0.0370, 0.2111, 0.1041, -0.1118, -0.1166, -0.2225, 0.0170, -0.1319, -0.1111, 0.2932, 0.2526,
        -0.0349, -0.1132, 0.1638, 0.0174, 0.0111, -0.1027, -0.0973, 0.0007, -0.0899, 0.1850, 0.0473,
        -0.2592, -0.0650, -0.0013, -0.0359, 0.0062, 0.1666, 0.0536, 0.0340, -0.0812, 0.0259, 0.2442,
        -0.0669, 0.2917, -0.2547, 0.0547, 0.1124, -0.0611, 0.0655, -0.2077, 0.1033, 0.0497, 0.0500,
        0.3229, -0.1073, 0.0463, -0.1494, 0.0527, -0.0622, 0.0177, -0.0254, -0.1082, 0.0008, 0.2345,
        0.0980, 0.0628, 0.1505, 0.1817, 0.1279, -0.1722, -0.1662, -0.0587, -0.0583, 0.3496, 0.1770,
        0.0221, 0.0552, -0.0329, -0.0809, -0.0836, -0.1173, 0.0419, 0.1041, 0.0313, 0.2555, -0.1032,
        -0.0800, -0.0827, 0.0219, -0.0393, 0.0357, -0.0368, -0.1148, 0.0236, -0.0674, -0.0657, -0.1168,
        -0.0355, -0.1900, 0.0454, 0.1895, 0.3395, -0.0501, -0.0145, 0.0693, -0.2789, -0.1534, 0.1054,
        -0.0003, 0.0470, 0.1376, 0.0277, 0.0038, 0.0873, 0.1624, -0.0358, -0.1771, -0.2987, -0.0324,
        -0.1197, 0.1260, -0.1786, 0.1080, 0.0735, -0.1635, 0.1484, 0.0205, -0.3442, 0.0024, -0.0311,
        -0.0397, 0.0233, 0.1519, -0.0678, 0.1639, -0.0005, -0.1551, 0.1739, 0.0611, 0.1379, 0.2505,
        -0.0229, 0.2451, 0.0071, 0.0919, -0.0049, 0.1523, -0.0474, -0.2320, -0.1735, -0.0118, 0.0123,
        0.1155, -0.1835, 0.0780, 0.1069, -0.1843, 0.0947, 0.0542, -0.1973, 0.0468, 0.0056, -0.0992,
        0.1147, 0.1305, -0.0884, 0.0092, 0.1032, -0.1408, 0.0891, 0.0417, -0.0484, 0.1399, -0.0730,
        0.1275, 0.0012, 0.0469, 0.1875, 0.2071, -0.0631, 0.0146, -0.0554, -0.0424, 0.0077, 0.0245,
        0.1607, 0.0141, 0.0536, 0.0084, 0.0373, 0.1088, -0.1019, -0.0079, 0.0385, 0.1858, 0.0002,
        0.0085, -0.0266, 0.0812, -0.0855, 0.1270, 0.0354, 0.4966, 0.0544, 0.2451, -0.0847, 0.0926,
        0.0056, 0.0582, 0.1859, 0.2427, -0.0436, -0.0039, -0.0785, -0.0296, -0.0829, 0.0166, 0.1749,
        0.0685, 0.0352, 0.0924, 0.0006, 0.1442, -0.1334, 0.0108, -0.0208, 0.2105, 0.0206, 0.0040,
        -0.0575, 0.0496, -0.1261, 0.1115, -0.0061, 0.4577, 0.0905, 0.2570, -0.0630, 0.1614, -0.0027,
        -0.0183, 0.0069, 0.3104, 0.1812, 0.0099, -0.1827, 0.1790, 0.0517, -0.0113, -0.3226, 0.0936,
        0.1782, -0.0137, -0.0349, 0.0083, -0.1834, -0.2367, -0.1461, 0.0655, -0.0044, 0.1903, 0.0055,
        0.2530, -0.0153, 0.1809, 0.0503, 0.1517, 0.1113, -0.1427, -0.2329, 0.1238, -0.2089, -0.1658,
        0.0671, -0.4439, -0.1695, -0.1555, -0.9664, -0.5116, -0.0987, 0.1397, 0.4031, -0.5643, 1.1317,
        -0.0648, 0.0026, 0.8452, -1.0534, 0.3547, 0.0283, 0.6095, 0.5137, -0.2022, -0.5911, 0.1131,
        0.5438, 0.4666, -0.7782, 0.4818, -0.5251, 0.2391, -0.6885, 0.6949, -1.0968, -0.3694, 0.2999,
        -0.2994, -0.2758, -0.4127, 0.1504, -0.3982, -0.2305, 0.6032, -0.4117, -0.2897, 0.1833, -0.1117,
        -0.0052, 0.1633, 0.1413, -0.2232, -0.3762, -0.2982, 0.3622, 0.8019, 0.1248, 0.3071, 0.0173,
        -0.0168, -0.5971, 0.2376, 0.3553, 0.6704, 0.1606, -0.0284, 0.0781, 0.1867, 0.3252, -0.4542,
        -0.4394, 0.0728, -0.5525, 0.0735, 0.3012, -0.0152, 0.2783, 0.3652, 0.4903, 0.1096, 0.2668,
        -0.3718, -0.4786, 0.5610, -0.6094, -0.2123, 0.1424, 0.5877, -0.1862, 0.4683, -0.0606, 0.1135,
        -0.2072, -0.0838, -0.4299, -0.2508, 0.4543, -0.5743, -0.5115, -0.3405, -0.2481, -0.0381, 0.1820,
        -0.0678, -0.5023, 0.2822, 0.1874, 0.2398, -0.3555, 0.3909, 0.3411, 0.2529, -0.1493, 0.2541,
        -0.1503, -0.4513, 0.1820, -0.0828, -0.4853, -0.0896, 0.1605, -0.4956, -0.0446, -0.3659, -0.1424,
        -0.5033, 0.4827, 0.1408, -0.4788, 0.3127, 0.1106, -0.0805, -0.0047, -0.0641, 0.0014, -0.0739,
        -0.0954, -0.1431, 0.3397, 0.4367, -0.2054, -0.1078, 0.3956, -0.3666, 0.2685, 0.0065, 0.0682,
        -0.1664, -0.5823, -0.0819, 0.2298, 0.6149, -0.1842, 0.4124, 0.1513, -0.3708, 0.2147, -0.2274,
        -0.4784, -0.3014, -0.3514, -0.5322, 0.6084, 0.0336, -0.2543, 0.2056, 0.4361, 0.0443, -0.5719,
        0.4654, 0.6159, 0.4572, 0.3534, 0.0076, -0.0725, -0.5389, 0.4467, -0.1927, -0.4852, -0.3802,
        -0.0734, -0.1861, 0.0745, -0.2592, -0.3401, -0.2434, 0.2119, 0.3186, -0.2338, 0.0442, -0.0010,
        0.2525, -0.1430, 0.0932, 0.1790, -0.0368, 0.2657, 0.4376, -0.2093, -0.5706, 0.2317, -0.5592,
        -0.2550, 0.3265, -0.2749, 0.4142, 0.3223, 0.3746, 0.0192, 0.1285, 0.0069, 0.0049, 0.4526,
        -0.3488, -0.3622, -0.4598, 0.4170, -0.5045, -0.4769, -0.4823, -0.4113, -0.2445, 0.2383, -0.1080,
        -0.5165, 0.3030, 0.5700, 0.0187, 0.4059, -0.4871, -0.4305, -0.3607, -0.1122, 0.1091, 0.0842,
        0.5588, -0.5073, -0.1546, 0.2017, 0.6089, -0.3551, 0.1956, 0.1537, 0.0237, 0.1793, 0.4350,
        -0.3740, -0.1302, 0.0341, -0.6028, -0.6207, -0.1673, 0.6404, -0.0865, -0.4133, -0.1098, -0.0515,
        -0.1835, 0.3356, 0.3454, -0.1276, 0.2408, 0.5438, 0.0924, -0.3518, 0.1885, 0.3035, 0.1642,
        0.3028, 0.5775, -0.3483, -0.2971, 0.3899, -0.0114, -0.4235, 0.3454, -0.0693, 0.2691, -0.1750,
        0.1784, 0.4465, 0.3064, -0.5235, -0.2562, 0.1969, -0.3356, -0.5052, 0.1913, -0.3816, 0.1209,
        0.1333, 0.3256, 0.6688, 0.0550, 0.4778, -0.3748, 0.1676, -0.4161, -0.1281, 0.2095, -0.3304,
        0.6193, 0.2338, 0.5843, -0.3023, -0.2350, 0.2163, 0.1550, 0.7712, -0.4390, -0.2684, 0.0215,
        0.2422, -0.4890, -0.3685, -0.1181, -0.6225, -0.0914, -0.2871, 0.5937, -0.4461, 0.1111, 0.2158,
        -0.1257, -0.0993, 0.7094, 0.6715, 0.1918, 0.0628, -0.0165, 0.2014, -0.3508, 0.4857, -0.4129,
        -0.2251, 0.2546, -0.3965, 0.2515, 0.3862, 0.3212, 0.5133, 0.4533, -0.8085, -0.1726, 0.2845,
        0.0259, -0.2492, -0.5358, 0.1431, -0.2921, 0.0062, -0.4225, -0.1914, -0.2522, 0.2387, 0.0979,
        -0.2290, 0.3582, 0.3606, 0.6594, -0.3774, 0.3612, 0.1090, 0.5253, 0.1805, 0.3794, -0.2099,
        -0.0930, 0.2996, -0.4878, -0.6463, -0.4950, 0.0497, -0.1747, 0.0042, -0.2645, -0.5788, -0.3662,
        0.5949, 0.4972, -0.2688, 0.1928, 0.1010, 0.1803, -0.4499, 0.3767, 0.2714, 0.4897, 0.2355,
        0.0729, -0.5025, -0.5162, 0.4401, -0.5476, -0.3292, 0.3763, -0.5986, 0.5180, 0.3580, 0.3355,
        -0.2579, -0.0953, -0.0393, 0.2368, 0.5043, -0.3167, -0.1229, -0.3730, 0.3586, -0.5712, -0.4013,
        -0.5125, -0.3980, -0.4608, 0.0514, 0.1209, -0.2481, 0.3043, 0.1244, 0.3055, -0.5600, 0.4221,
        0.5339, 0.3317, -0.0226, 0.3137, 0.3392, 0.2594, 0.4337, -0.3085, -0.3892, -1.3764, 1.3272,
        -1.2039, -1.0969, -1.4509, -1.5469, -1.0097, 1.5788, 1.5444, -1.2565, 1.3652, 1.3313, 0.2226,
    ]),
};
