//! The kiosk's own few words, by language. Everything about a work is in its exhibit's labels; this is only what the
//! kiosk itself must say, and what it says where a label is silent.

/// What the kiosk itself says in one language.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Words {
    /// Language code.
    pub code: &'static str,
    /// The language's name in the language.
    pub name: &'static str,
    /// Invites to blow (a label's text `invite` goes before it).
    pub invite: &'static str,
    /// Invites where there is no microphone (a label's text `hold` goes before it).
    pub hold: &'static str,
    /// What becomes of what the microphone hears.
    pub privacy: &'static str,
}

/// All languages that the kiosk itself speaks; the first stands in for the others.
pub const WORDS: &[Words] = &[
    Words {
        code: "en",
        name: "English",
        invite: "Blow gently",
        hold: "Press and hold to blow",
        privacy: "The microphone measures air. Nothing is recorded.",
    },
    Words {
        code: "de",
        name: "Deutsch",
        invite: "Sanft pusten",
        hold: "Zum Pusten gedrückt halten",
        privacy: "Das Mikrofon misst Luft. Nichts wird aufgezeichnet.",
    },
    Words {
        code: "fr",
        name: "Français",
        invite: "Soufflez doucement",
        hold: "Appuyez et maintenez pour souffler",
        privacy: "Le microphone mesure l’air. Rien n’est enregistré.",
    },
    Words {
        code: "it",
        name: "Italiano",
        invite: "Soffia piano",
        hold: "Tieni premuto per soffiare",
        privacy: "Il microfono misura l’aria. Nulla viene registrato.",
    },
    Words {
        code: "es",
        name: "Español",
        invite: "Sopla suavemente",
        hold: "Mantén pulsado para soplar",
        privacy: "El micrófono mide el aire. No se graba nada.",
    },
    Words {
        code: "ko",
        name: "한국어",
        invite: "가볍게 불어 보세요",
        hold: "길게 눌러 불어 보세요",
        privacy: "마이크는 공기만 측정합니다. 아무것도 녹음하지 않습니다.",
    },
    Words {
        code: "ja",
        name: "日本語",
        invite: "そっと息を吹きかけてください",
        hold: "長押しすると風が吹きます",
        privacy: "マイクは空気の動きだけを測ります。録音はしません。",
    },
];

/// The kiosk's words in a language (`pt-BR` is looked up as `pt`), or the first ones.
pub fn words(language: &str) -> &'static Words {
    known(language).unwrap_or(&WORDS[0])
}

/// The name of a language in the language; its code where the kiosk does not know it.
pub fn language_name(language: &str) -> &str {
    known(language).map_or(language, |words| words.name)
}

fn known(language: &str) -> Option<&'static Words> {
    let base = language.split(['-', '_']).next().unwrap_or(language);
    WORDS.iter().find(|words| words.code.eq_ignore_ascii_case(base))
}
