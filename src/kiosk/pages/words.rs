//! The kiosk's own few words, by language. Everything about a work is in its exhibit's labels; this is only what the
//! kiosk itself must say, and what it says where a label is silent.

use crate::visitor::needs::Needs;

/// What the kiosk itself says in one language.
///
/// 35 fields, because it is a plain table of strings with one row a language: a field that a translation lacks does not
/// compile.
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
    /// How to blow where nobody need hold: press, and press again.
    pub press: &'static str,
    /// That choice, as what is switched.
    pub press_once: &'static str,
    /// How to blow by resting the pointer.
    pub dwells: &'static str,
    /// That choice, as what is switched.
    pub dwell: &'static str,
    /// Less motion, as what is switched.
    pub calm: &'static str,
    /// Looking round the work, as what is switched.
    pub round: &'static str,
    /// How to look round.
    pub round_pull: &'static str,
    /// The same for whoever presses once.
    pub round_press: &'static str,
    /// Reads aloud.
    pub speak: &'static str,
    /// The work makes no sound.
    pub no_sound: &'static str,
    /// Turns the volume up, as it is read aloud.
    pub louder: &'static str,
    /// Turns it down.
    pub softer: &'static str,
    /// Turns to the next leaf of works, as it is read aloud.
    pub next: &'static str,
    /// Turns to the leaf before.
    pub previous: &'static str,
    /// What is switched is on, as it is read aloud.
    pub on: &'static str,
    /// It is off.
    pub off: &'static str,
}

impl Words {
    /// How one blows without a breath.
    pub fn how(&self, needs: Needs) -> &'static str {
        match (needs.dwell, needs.press_once) {
            (true, _) => self.dwells,
            (false, true) => self.press,
            (false, false) => self.hold,
        }
    }

    /// How one looks round.
    pub fn how_round(&self, needs: Needs) -> &'static str {
        if needs.once() { self.round_press } else { self.round_pull }
    }

    /// All of them, for whoever checks that none is missing.
    pub fn all(&self) -> [&'static str; 35] {
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
            self.press,
            self.press_once,
            self.dwells,
            self.dwell,
            self.calm,
            self.round,
            self.round_pull,
            self.round_press,
            self.speak,
            self.no_sound,
            self.louder,
            self.softer,
            self.next,
            self.previous,
            self.on,
            self.off,
        ]
    }
}

/// Names of languages in which labels are written and which the kiosk itself does not speak.
const OTHER_NAMES: &[(&str, &str)] = &[
    ("ar", "العربية"),
    ("cs", "Čeština"),
    ("da", "Dansk"),
    ("el", "Ελληνικά"),
    ("fa", "فارسی"),
    ("fi", "Suomi"),
    ("he", "עברית"),
    ("hu", "Magyar"),
    ("nl", "Nederlands"),
    ("no", "Norsk"),
    ("pl", "Polski"),
    ("pt", "Português"),
    ("ru", "Русский"),
    ("sv", "Svenska"),
    ("tr", "Türkçe"),
    ("uk", "Українська"),
    ("ur", "اردو"),
    ("zh", "中文"),
];

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
        press: "Press to blow, press again to stop",
        press_once: "Press once",
        dwells: "Rest the pointer to blow, move and rest again to stop",
        dwell: "Rest to press",
        calm: "Less motion",
        round: "Look round",
        round_pull: "Drag beside the work to look round it",
        round_press: "Press beside the work to look round it",
        speak: "Read aloud",
        no_sound: "This work makes no sound.",
        louder: "Louder",
        softer: "Softer",
        next: "More works",
        previous: "Works before these",
        on: "on",
        off: "off",
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
        press: "Zum Pusten drücken, zum Beenden noch einmal",
        press_once: "Einmal drücken",
        dwells: "Zeiger ruhen lassen zum Pusten, bewegen und ruhen lassen zum Beenden",
        dwell: "Ruhen statt drücken",
        calm: "Weniger Bewegung",
        round: "Herumschauen",
        round_pull: "Neben dem Werk ziehen, um es von der Seite zu sehen",
        round_press: "Neben das Werk drücken, um es von der Seite zu sehen",
        speak: "Vorlesen",
        no_sound: "Dieses Werk macht keinen Ton.",
        louder: "Lauter",
        softer: "Leiser",
        next: "Weitere Werke",
        previous: "Werke davor",
        on: "ein",
        off: "aus",
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
        press: "Appuyez pour souffler, appuyez encore pour arrêter",
        press_once: "Un seul appui",
        dwells: "Laissez le pointeur immobile pour souffler, encore ailleurs pour arrêter",
        dwell: "Pointer sans appuyer",
        calm: "Moins de mouvement",
        round: "Tourner autour",
        round_pull: "Glissez à côté de l’œuvre pour tourner autour",
        round_press: "Appuyez à côté de l’œuvre pour tourner autour",
        speak: "Lire à voix haute",
        no_sound: "Cette œuvre ne fait aucun son.",
        louder: "Plus fort",
        softer: "Moins fort",
        next: "Œuvres suivantes",
        previous: "Œuvres précédentes",
        on: "activé",
        off: "désactivé",
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
        press: "Premi per soffiare, premi ancora per smettere",
        press_once: "Un solo tocco",
        dwells: "Tieni fermo il puntatore per soffiare, di nuovo altrove per smettere",
        dwell: "Puntare senza premere",
        calm: "Meno movimento",
        round: "Girare intorno",
        round_pull: "Trascina accanto all’opera per girarle intorno",
        round_press: "Premi accanto all’opera per girarle intorno",
        speak: "Leggi ad alta voce",
        no_sound: "Quest’opera non fa suoni.",
        louder: "Più forte",
        softer: "Più piano",
        next: "Opere successive",
        previous: "Opere precedenti",
        on: "acceso",
        off: "spento",
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
        press: "Pulsa para soplar, pulsa otra vez para parar",
        press_once: "Pulsar una vez",
        dwells: "Deja quieto el puntero para soplar, y otra vez en otro sitio para parar",
        dwell: "Apuntar sin pulsar",
        calm: "Menos movimiento",
        round: "Mirar alrededor",
        round_pull: "Arrastra junto a la obra para verla desde otro lado",
        round_press: "Pulsa junto a la obra para verla desde otro lado",
        speak: "Leer en voz alta",
        no_sound: "Esta obra no suena.",
        louder: "Más alto",
        softer: "Más bajo",
        next: "Obras siguientes",
        previous: "Obras anteriores",
        on: "activado",
        off: "desactivado",
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
        press: "누르면 바람이 불고 다시 누르면 멈춥니다",
        press_once: "한 번 누르기",
        dwells: "포인터를 멈추면 바람이 불고, 옮겨서 다시 멈추면 그칩니다",
        dwell: "멈춰서 누르기",
        calm: "움직임 줄이기",
        round: "둘러보기",
        round_pull: "작품 옆을 끌면 다른 쪽에서 볼 수 있습니다",
        round_press: "작품 옆을 누르면 다른 쪽에서 볼 수 있습니다",
        speak: "소리 내어 읽기",
        no_sound: "이 작품은 소리가 나지 않습니다.",
        louder: "소리 크게",
        softer: "소리 작게",
        next: "다음 작품들",
        previous: "이전 작품들",
        on: "켜짐",
        off: "꺼짐",
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
        press: "押すと風が吹き、もう一度押すと止まります",
        press_once: "一度押し",
        dwells: "ポインターを止めると風が吹き、動かしてまた止めると止まります",
        dwell: "止めて押す",
        calm: "動きを減らす",
        round: "まわりから見る",
        round_pull: "作品の横を引くと、まわりから見られます",
        round_press: "作品の横を押すと、まわりから見られます",
        speak: "読み上げ",
        no_sound: "この作品は音が出ません。",
        louder: "音を大きく",
        softer: "音を小さく",
        next: "次の作品",
        previous: "前の作品",
        on: "オン",
        off: "オフ",
    },
];

/// The kiosk's words in a language (`pt-BR` is looked up as `pt`), or the first ones.
pub fn words(language: &str) -> &'static Words {
    known(language).unwrap_or(&WORDS[0])
}

/// The name of a language in the language; its code where the kiosk does not know it.
pub fn language_name(language: &str) -> &str {
    let base = base(language);
    let other = || OTHER_NAMES.iter().find(|(code, _)| code.eq_ignore_ascii_case(base)).map(|(_, name)| *name);
    known(language).map(|words| words.name).or_else(other).unwrap_or(language)
}

/// A code without its region.
fn base(language: &str) -> &str {
    language.split(['-', '_']).next().unwrap_or(language)
}

fn known(language: &str) -> Option<&'static Words> {
    let base = base(language);
    WORDS.iter().find(|words| words.code.eq_ignore_ascii_case(base))
}
