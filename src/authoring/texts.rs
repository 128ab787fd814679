//! Texts of a new sidecar: attract script, labels in three languages, credit. Each text asks to be replaced.

use std::fmt::Write;

/// Label texts of one language.
#[derive(Clone, Debug, Default)]
pub struct LabelTexts {
    /// Language code.
    pub code: &'static str,
    /// Title of the exhibit.
    pub title: String,
    /// Maker.
    pub maker: String,
    /// Wall text.
    pub body: String,
    /// Description for visitors who cannot see it.
    pub alt: String,
    /// Captions by key.
    pub captions: Vec<(&'static str, String)>,
}

/// A breath of the attract script.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AttractBreath {
    /// Seconds since the script began.
    pub at: f64,
    /// Speed at the lips over that of the hardest blow, 0…1.
    pub strength: f64,
    /// Picture coordinates: (0,0) top left, (1,1) bottom right.
    pub aim: [f64; 2],
}

/// A text as a TOML string.
pub fn quoted(text: &str) -> String {
    toml_edit::Value::from(text).to_string()
}

/// The attract script: the invitation, and breaths. A hanging exhibit comes to rest by itself and needs no reset.
pub fn attract(breaths: &[AttractBreath]) -> String {
    let end = breaths.last().map_or(20.0, |breath| breath.at + 19.0);
    let mut out = format!(
        "# ---- when nobody is there ------------------------------------------------------------------------------------\n\
         # Steps in increasing time, seconds since the script began. A step shows a text, blows, orbits the\n\
         # camera (camera = [\"20 deg\", \"5 deg\"] to the right and up, [0, 0] back), or resets the exhibit to its\n\
         # start (reset = true): that is a jump, for exhibits whose parts break or roll away.\n\
         # strength: 0.22 is a gentle breath, 1 the hardest. aim: (0,0) is the picture's top left, (1,1) its bottom right.\n\n\
         [attract]\nduration = {end}\n\n[[attract.step]]\nat = 0\nshow = \"invite\"\n"
    );
    for AttractBreath { at, strength, aim: [x, y] } in breaths {
        let _ = write!(
            out,
            "\n[[attract.step]]\nat = {at}\nblow = {{ strength = {strength}, hold = \"1.5 s\", aim = [{x}, {y}] }}\n"
        );
    }
    out
}

/// The label and credit tables.
pub fn labels(languages: &[LabelTexts]) -> String {
    let mut out = "# ---- words ---------------------------------------------------------------------------------------------------\n\
                   # REPLACE these texts; `soffio labels ID --csv texts.csv` makes a table of them for translators. `alt`\n\
                   # describes the exhibit to visitors who cannot see it; `caption` is shown when a sound plays.\n\n\
                   [label]\ndefault_language = \"en\"\n"
        .to_owned();
    for LabelTexts { code, title, maker, body, alt, captions } in languages {
        let invite = match *code {
            "ko" => "부드럽게 불어 보세요. 고리를 움직여 방향을 정하세요.",
            "it" => "Soffia piano. Muovi l'anello per mirare.",
            _ => "Blow gently. Move the ring to aim.",
        };
        let captions: Vec<String> = captions.iter().map(|(key, text)| format!("{key} = {}", quoted(text))).collect();
        let _ = write!(
            out,
            "\n[label.{code}]\ntitle = {}\nmaker = {}\nbody = {}\nalt = {}\ntext = {{ invite = {} }}\ncaption = {{ {} }}\n",
            quoted(title),
            quoted(maker),
            quoted(body),
            quoted(alt),
            quoted(invite),
            captions.join(", ")
        );
    }
    out += "\n# Whose work this is, under which licence (https://spdx.org/licenses), and where the label's facts come from.\n\
            [credit]\nmodel_license = \"LicenseRef-REPLACE\"\nmodel_author = \"REPLACE by the maker's name\"\nsources = []\n";
    out
}

/// English, Korean and Italian texts of a new exhibit: title, wall text, description, and captions by key.
pub fn in_three_languages(
    titles: [&str; 3],
    bodies: [&str; 3],
    alts: [String; 3],
    captions: &[(&'static str, [&str; 3])],
) -> Vec<LabelTexts> {
    let makers = ["REPLACE: the maker's name", "바꾸세요: 만든 이의 이름", "DA SOSTITUIRE: il nome dell'autore"];
    let begin = [
        "REPLACE this text: who made it, when, of what, and what a breath does to it.",
        "이 글을 바꾸세요: 누가, 언제, 무엇으로 만들었고, 숨결이 닿으면 어떻게 되는지.",
        "DA SOSTITUIRE: chi l'ha fatto, quando, di che cosa, e che cosa fa un soffio.",
    ];
    let mut alts = alts.into_iter();
    ["en", "ko", "it"]
        .into_iter()
        .enumerate()
        .map(|(i, code)| LabelTexts {
            code,
            title: titles[i].to_owned(),
            maker: makers[i].to_owned(),
            body: format!("{} {}", begin[i], bodies[i]),
            alt: alts.next().unwrap_or_default(),
            captions: captions.iter().map(|(key, texts)| (*key, texts[i].to_owned())).collect(),
        })
        .collect()
}
