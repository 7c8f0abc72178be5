//! Words in names of nodes and materials that say what a body is, in several languages.

use crate::material::Metal;

/// Words for stones, each with its preset if it says which.
const STONES: [(&[&str], Option<&str>); 8] = [
    (
        &[
            "diamond",
            "diamant",
            "diamante",
            "diament",
            "diamanten",
            "briljant",
            "brilliant",
            "brillant",
            "brillante",
            "brylant",
            "brilant",
            "dia",
            "elmas",
            "gyemant",
            "timantti",
            "алмаз",
            "бриллиант",
            "диамант",
            "钻石",
            "鑽石",
            "タイヤモント",
        ],
        Some("diamond"),
    ),
    (&["ruby", "rubin", "rubino", "rubi", "rubis", "robijn", "yakut", "рубин", "红宝石"], Some("ruby")),
    (
        &[
            "sapphire",
            "saphir",
            "saphire",
            "zaffiro",
            "zafiro",
            "safira",
            "saffier",
            "safir",
            "szafir",
            "сапфир",
            "蓝宝石",
        ],
        Some("sapphire"),
    ),
    (
        &[
            "emerald",
            "emeraude",
            "smeraldo",
            "esmeralda",
            "smaragd",
            "szmaragd",
            "smaragdo",
            "zumrut",
            "изумруд",
            "祖母绿",
        ],
        Some("emerald"),
    ),
    (&["moissanite", "moissanit", "moissanita", "муассанит"], Some("moissanite")),
    (
        &["zirconia", "zirkonia", "cyrkonia", "zirconium", "zircon", "zirkon", "cyrkon", "zirconita", "cz", "фианит"],
        Some("zirconia"),
    ),
    (&["quartz", "quarz", "quarzo", "cuarzo", "kwarc", "kwarts", "кварц"], Some("quartz")),
    (
        &[
            "gem",
            "gemstone",
            "gema",
            "gemma",
            "gemme",
            "stone",
            "stein",
            "edelstein",
            "pierre",
            "pietra",
            "piedra",
            "pedra",
            "kamien",
            "kamen",
            "steen",
            "edelsteen",
            "sten",
            "adelsten",
            "kivi",
            "drahokam",
            "jewel",
            "joyau",
            "gioiello",
            "juwel",
            "tas",
            "камень",
            "камни",
            "宝石",
            "寶石",
            "宝珠",
            "石",
        ],
        None,
    ),
];

/// Words for metals, each with the metal; the last ones name none.
const METALS: [(&[&str], Option<Metal>); 9] = [
    (
        &["gold", "golden", "oro", "ouro", "or", "zloto", "zloty", "goud", "guld", "altin", "kulta", "золото", "金"],
        Some(Metal::Gold),
    ),
    (&["yellowgold", "gelbgold"], Some(Metal::YellowGold)),
    (&["rosegold", "rotgold", "rose", "rosa"], Some(Metal::RoseGold)),
    (&["whitegold", "weissgold"], Some(Metal::WhiteGold)),
    (
        &[
            "silver",
            "silber",
            "argent",
            "argento",
            "plata",
            "prata",
            "srebro",
            "zilver",
            "solv",
            "gumus",
            "hopea",
            "серебро",
            "银",
        ],
        Some(Metal::Silver),
    ),
    (&["platinum", "platin", "platine", "platino", "platyna", "platina", "платина", "铂"], Some(Metal::Platinum)),
    (&["copper", "kupfer", "cuivre", "rame", "cobre", "miedz", "koper", "медь", "铜"], Some(Metal::Copper)),
    (&["steel", "stahl", "acier", "acciaio", "acero", "stal", "staal", "сталь", "钢"], Some(Metal::Steel)),
    (&["metal", "metall", "metallo", "metaal", "prong", "prongs", "металл", "金属"], None),
];

/// Words that mean something else in other languages or as a part of a phrase, or that name a part rather than its matter.
const AMBIGUOUS: [&str; 9] = ["or", "rame", "plata", "rose", "rosa", "stal", "metal", "prong", "prongs"];

/// Whether a word for a metal means something else as well.
pub(super) fn is_ambiguous(word: &str) -> bool {
    AMBIGUOUS.contains(&word)
}

/// Words that were found.
#[derive(Debug, PartialEq)]
pub(super) struct Words {
    /// A word for a stone, and its preset if it says which; that one if there are several.
    pub(super) stone: Option<(String, Option<&'static str>)>,
    /// A word for a metal, and the metal if the word says which.
    pub(super) metal: Option<(String, Option<Metal>)>,
}

impl Words {
    /// Finds whole words, also in `camelCase`, before numbers, and without their accents.
    pub(super) fn of(names: [&String; 2]) -> Self {
        let words: Vec<String> = names.into_iter().flat_map(|name| split(name)).collect();
        let stone = |word: &String| {
            let found = STONES.iter().find(|(words, _)| is_one(word, words));
            found.map(|(_, preset)| (word.clone(), *preset))
        };
        let metal = |word: &String| {
            let found = METALS.iter().find(|(words, _)| is_one(word, words));
            found.map(|(_, metal)| (word.clone(), *metal))
        };
        let stones: Vec<_> = words.iter().filter_map(stone).collect();
        let metals: Vec<_> = words.iter().filter_map(metal).collect();
        let which = stones.iter().find(|(_, preset)| preset.is_some()).or(stones.first()).cloned();
        Self { stone: which, metal: alloy(&words, &metals) }
    }
}

/// Words for the colour of an alloy of gold.
const ALLOYS: [(&[&str], Metal); 3] = [
    (&["rose", "rosa", "pink", "red", "rot", "rouge", "rosso"], Metal::RoseGold),
    (&["white", "weiss", "blanc", "bianco", "blanco", "biale"], Metal::WhiteGold),
    (&["yellow", "gelb", "jaune", "giallo", "amarillo", "zolte"], Metal::YellowGold),
];

/// Returns the metal that words name, by two of them for alloys of gold.
fn alloy(words: &[String], metals: &[(String, Option<Metal>)]) -> Option<(String, Option<Metal>)> {
    let gold = metals.iter().find(|(_, metal)| *metal == Some(Metal::Gold));
    if let Some((word, gold)) = gold {
        let has = |of: &[&str]| words.iter().any(|word| is_one(word, of));
        let alloy = ALLOYS.iter().find(|(words, _)| has(words)).map(|(_, alloy)| *alloy);
        return Some((word.clone(), alloy.or(*gold)));
    }
    // Named metals before the plain word, and a rose alone is a flower.
    let named = metals.iter().filter(|(word, _)| !["rose", "rosa"].contains(&word.as_str()));
    named.clone().find(|(_, metal)| metal.is_some()).or(named.clone().next()).cloned()
}

/// Whether a word is one of these, or the plural of one.
fn is_one(word: &str, of: &[&str]) -> bool {
    let is_plural = |ending: &str| {
        let stem = word.strip_suffix(ending).filter(|stem| stem.chars().count() >= if ending == "s" { 3 } else { 4 });
        stem.is_some_and(|stem| of.contains(&stem))
    };
    of.contains(&word) || ["s", "es", "e", "n", "en", "i"].into_iter().any(is_plural)
}

/// Returns the words of a name, in lower case and without accents.
fn split(name: &str) -> Vec<String> {
    let mut words = Vec::new();
    let mut word = String::new();
    let letters: Vec<char> = name.chars().filter(|letter| !is_mark(*letter)).collect();
    for (place, &letter) in letters.iter().enumerate() {
        let last = place.checked_sub(1).map(|place| letters[place]);
        let next = letters.get(place + 1);
        // Between `mS` of `GemStone`, and before `St` of `GEMStone`.
        let begins = letter.is_uppercase()
            && last.is_some_and(|last| {
                last.is_lowercase() || last.is_uppercase() && next.is_some_and(|next| next.is_lowercase())
            });
        if (begins || !letter.is_alphabetic()) && !word.is_empty() {
            words.push(std::mem::take(&mut word));
        }
        if letter.is_alphabetic() {
            // A capital such as `İ` is a letter and a mark in lower case.
            letter.to_lowercase().filter(|letter| !is_mark(*letter)).for_each(|letter| match letter {
                'ß' => word.push_str("ss"),
                letter => word.push(plain(letter)),
            });
        }
    }
    if !word.is_empty() {
        words.push(word);
    }
    words
}

/// Whether a character is a mark on the letter before it: an accent, or one of kana, as programs write that decompose letters.
fn is_mark(letter: char) -> bool {
    matches!(letter, '\u{300}'..='\u{36f}' | '\u{3099}' | '\u{309a}')
}

/// Returns a letter without its accent.
fn plain(letter: char) -> char {
    match letter {
        'à' | 'á' | 'â' | 'ã' | 'ä' | 'å' | 'ą' => 'a',
        'ç' | 'ć' | 'č' => 'c',
        'è' | 'é' | 'ê' | 'ë' | 'ę' | 'ě' => 'e',
        'ì' | 'í' | 'î' | 'ï' | 'ı' => 'i',
        'ł' => 'l',
        'ñ' | 'ń' | 'ň' => 'n',
        'ò' | 'ó' | 'ô' | 'õ' | 'ö' | 'ø' => 'o',
        'ś' | 'š' | 'ş' => 's',
        'ù' | 'ú' | 'û' | 'ü' | 'ů' => 'u',
        'ý' => 'y',
        'ź' | 'ż' | 'ž' => 'z',
        'ダ' => 'タ',
        'ド' => 'ト',
        other => other,
    }
}
