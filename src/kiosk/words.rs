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
    /// Opens the page with all the rest.
    pub more: &'static str,
    /// Leads back from it.
    pub back: &'static str,
    /// How to aim.
    pub aim: &'static str,
    /// How to take the sculpture by the hand.
    pub take: &'static str,
    /// Large type.
    pub large: &'static str,
    /// High contrast.
    pub contrast: &'static str,
    /// The microphone, as what is switched.
    pub ear: &'static str,
    /// It is off.
    pub ear_off: &'static str,
    /// The sound is off.
    pub silent: &'static str,
    /// After much hard blowing.
    pub rest: &'static str,
    /// How to stay when the kiosk takes it that nobody is there.
    pub stay: &'static str,
    /// The same where nothing hears a breath.
    pub stay_touch: &'static str,
    /// Invites where the site does not want visitors to blow.
    pub no_breath: &'static str,
    /// While the glass is cleaned.
    pub cleaning: &'static str,
}

impl Words {
    /// All of them, for whoever checks that none is missing.
    pub fn all(&self) -> [&'static str; 19] {
        [
            self.code,
            self.name,
            self.invite,
            self.hold,
            self.privacy,
            self.more,
            self.back,
            self.aim,
            self.take,
            self.large,
            self.contrast,
            self.ear,
            self.ear_off,
            self.silent,
            self.rest,
            self.stay,
            self.stay_touch,
            self.no_breath,
            self.cleaning,
        ]
    }
}

/// All languages that the kiosk itself speaks; the first stands in for the others.
pub const WORDS: &[Words] = &[
    Words {
        code: "en",
        name: "English",
        invite: "Blow gently",
        hold: "Press and hold to blow",
        privacy: "The microphone measures air. Nothing is recorded.",
        more: "More",
        back: "Back to the work",
        aim: "Touch or point: the ring shows where the breath goes",
        take: "Press and pull: take it by the hand",
        large: "Large text",
        contrast: "High contrast",
        ear: "Microphone",
        ear_off: "The microphone is off.",
        silent: "The sound is off.",
        rest: "Have a rest and breathe calmly.",
        stay: "Touch or blow to stay",
        stay_touch: "Touch to stay",
        no_breath: "Today without breath: press and hold to blow",
        cleaning: "The glass is being cleaned",
    },
    Words {
        code: "de",
        name: "Deutsch",
        invite: "Sanft pusten",
        hold: "Zum Pusten gedrückt halten",
        privacy: "Das Mikrofon misst Luft. Nichts wird aufgezeichnet.",
        more: "Mehr",
        back: "Zurück zum Werk",
        aim: "Berühren oder zeigen: Der Ring zeigt, wohin der Atem geht",
        take: "Drücken und ziehen: Nimm es in die Hand",
        large: "Große Schrift",
        contrast: "Hoher Kontrast",
        ear: "Mikrofon",
        ear_off: "Das Mikrofon ist aus.",
        silent: "Der Ton ist aus.",
        rest: "Mach eine Pause und atme ruhig.",
        stay: "Berühren oder pusten, um zu bleiben",
        stay_touch: "Berühren, um zu bleiben",
        no_breath: "Heute ohne Atem: zum Pusten gedrückt halten",
        cleaning: "Das Glas wird gereinigt",
    },
    Words {
        code: "fr",
        name: "Français",
        invite: "Soufflez doucement",
        hold: "Appuyez et maintenez pour souffler",
        privacy: "Le microphone mesure l’air. Rien n’est enregistré.",
        more: "Plus",
        back: "Retour à l’œuvre",
        aim: "Touchez ou pointez : l’anneau montre où va le souffle",
        take: "Appuyez et tirez : prenez-la par la main",
        large: "Grand texte",
        contrast: "Contraste élevé",
        ear: "Microphone",
        ear_off: "Le microphone est éteint.",
        silent: "Le son est coupé.",
        rest: "Faites une pause et respirez calmement.",
        stay: "Touchez ou soufflez pour rester",
        stay_touch: "Touchez pour rester",
        no_breath: "Aujourd’hui sans souffle : appuyez et maintenez pour souffler",
        cleaning: "Nettoyage de l’écran en cours",
    },
    Words {
        code: "it",
        name: "Italiano",
        invite: "Soffia piano",
        hold: "Tieni premuto per soffiare",
        privacy: "Il microfono misura l’aria. Nulla viene registrato.",
        more: "Altro",
        back: "Torna all’opera",
        aim: "Tocca o indica: l’anello mostra dove va il soffio",
        take: "Premi e tira: prendila con la mano",
        large: "Testo grande",
        contrast: "Alto contrasto",
        ear: "Microfono",
        ear_off: "Il microfono è spento.",
        silent: "L’audio è spento.",
        rest: "Fai una pausa e respira con calma.",
        stay: "Tocca o soffia per restare",
        stay_touch: "Tocca per restare",
        no_breath: "Oggi senza fiato: tieni premuto per soffiare",
        cleaning: "Lo schermo viene pulito",
    },
    Words {
        code: "es",
        name: "Español",
        invite: "Sopla suavemente",
        hold: "Mantén pulsado para soplar",
        privacy: "El micrófono mide el aire. No se graba nada.",
        more: "Más",
        back: "Volver a la obra",
        aim: "Toca o señala: el anillo muestra adónde va el soplo",
        take: "Pulsa y arrastra: tómala con la mano",
        large: "Texto grande",
        contrast: "Alto contraste",
        ear: "Micrófono",
        ear_off: "El micrófono está apagado.",
        silent: "El sonido está apagado.",
        rest: "Descansa un poco y respira con calma.",
        stay: "Toca o sopla para quedarte",
        stay_touch: "Toca para quedarte",
        no_breath: "Hoy sin soplar: mantén pulsado para mover el aire",
        cleaning: "Se está limpiando la pantalla",
    },
    Words {
        code: "ko",
        name: "한국어",
        invite: "가볍게 불어 보세요",
        hold: "길게 눌러 불어 보세요",
        privacy: "마이크는 공기만 측정합니다. 아무것도 녹음하지 않습니다.",
        more: "더 보기",
        back: "작품으로 돌아가기",
        aim: "만지거나 가리키면 고리가 바람이 갈 곳을 보여 줍니다",
        take: "눌러서 당기면 손으로 잡을 수 있습니다",
        large: "큰 글씨",
        contrast: "고대비",
        ear: "마이크",
        ear_off: "마이크가 꺼져 있습니다.",
        silent: "소리가 꺼져 있습니다.",
        rest: "잠시 쉬면서 편하게 숨을 쉬세요.",
        stay: "계속하려면 만지거나 불어 보세요",
        stay_touch: "계속하려면 만져 보세요",
        no_breath: "오늘은 불지 않습니다: 길게 눌러 바람을 보내세요",
        cleaning: "화면을 닦고 있습니다",
    },
    Words {
        code: "ja",
        name: "日本語",
        invite: "そっと息を吹きかけてください",
        hold: "長押しすると風が吹きます",
        privacy: "マイクは空気の動きだけを測ります。録音はしません。",
        more: "もっと見る",
        back: "作品に戻る",
        aim: "触れるか指すと、息の行き先を輪が示します",
        take: "押して引くと、手でつかめます",
        large: "大きな文字",
        contrast: "高コントラスト",
        ear: "マイク",
        ear_off: "マイクはオフです。",
        silent: "音はオフです。",
        rest: "少し休んで、ゆっくり息をしてください。",
        stay: "続けるには触れるか息を吹いてください",
        stay_touch: "続けるには触れてください",
        no_breath: "今日は息を吹きかけず、長押しで風を送ってください",
        cleaning: "画面を清掃しています",
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
