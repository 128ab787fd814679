//! Codes of all diagnostics. A code never changes its meaning, and a retired code is not used again.
//!
//! Retired: E0232 (a closed loop) and E0233 (a freedom constrained twice). Loops are solved now, and W0407 warns of
//! redundancy.
//! E00xx files, E01xx structure of the sidecar, E02xx its content, E03xx the model, E05xx the site's configuration,
//! E06xx input of the curator's tools, W0xxx warnings.

/// A diagnostic's stable code and its meaning in one line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Code {
    /// Such as `E0207`.
    pub name: &'static str,
    /// Meaning, for listings.
    pub meaning: &'static str,
}

macro_rules! codes {
    ($($constant:ident = $name:literal, $meaning:literal;)*) => {
        $(#[doc = $meaning] pub const $constant: Code = Code { name: $name, meaning: $meaning };)*
        /// Every code.
        pub const ALL: &[Code] = &[$($constant),*];
    };
}

codes! {
    NO_EXHIBIT = "E0001", "no exhibit of this id or folder";
    UNREADABLE = "E0002", "a file cannot be read";
    OUTSIDE = "E0003", "a path leaves the exhibit folder";
    TOO_LARGE = "E0004", "a file is larger than the limit";
    BUDGET = "E0005", "the exhibit needs more memory or processor time than it may take";
    NOT_A_FILE = "E0006", "a path leads to something that is no regular file";
    SYNTAX = "E0101", "the sidecar is not TOML";
    UNKNOWN_KEY = "E0102", "the sidecar has a key that the format does not know";
    MISSING_KEY = "E0103", "a required key is missing";
    WRONG_TYPE = "E0104", "a value has the wrong type or unit";
    WRONG_SHAPE = "E0105", "a value is not among those allowed";
    VERSION = "E0106", "the sidecar's format version is not known";
    DUPLICATE_NAME = "E0201", "two items of a kind have the same name";
    NOT_FOUND = "E0207", "no node of this name";
    AMBIGUOUS = "E0208", "several nodes have this name";
    UNKNOWN_MATERIAL = "E0209", "no material of this name";
    UNKNOWN_BODY = "E0210", "the node is not a body";
    DUPLICATE_BODY = "E0211", "a node is declared a body twice";
    NOT_CLOSED = "E0220", "a mesh is not closed, so its volume is unknown";
    INSIDE_OUT = "E0221", "the faces of a mesh point inwards";
    NO_MASS = "E0222", "a body has no mass";
    INERTIA = "E0223", "an inertia breaks the triangle inequality";
    SCALED_BODY = "E0224", "the node of a body is scaled unevenly or mirrored";
    NOT_DESCENDANT = "E0225", "a node does not belong to the body";
    RANGE = "E0226", "a number is out of its range";
    BOTH_STATIC = "E0230", "a constraint joins two fixed nodes, or a body to itself";
    APART = "E0231", "the two points of a constraint are apart at the start";
    NOT_PERPENDICULAR = "E0234", "the two axes of an orientation are not at their angle at the start";
    NO_AXIS = "E0235", "a direction has no length";
    CONTRADICTORY = "E0236", "a constraint contradicts others";
    GEAR_RING = "E0237", "a ring of gears cannot turn";
    WINDOW = "E0238", "a time window is invalid";
    UNKNOWN_CONSTRAINT = "E0239", "no constraint of this name";
    NOT_HELD = "E0242", "an element frees a freedom that its constraint does not constrain by a row of its own";
    NO_BREAK = "E0243", "a breakable constraint has no breaking load";
    KEYS = "E0244", "the keys of a function or path are not in increasing time";
    NO_MOTION = "E0245", "a kinematic body has no motion to follow";
    NO_MESH = "E0240", "a node has no mesh to take a shape from";
    NOT_FLAT = "E0241", "a mesh has no outline to fit a plate to";
    NO_COLLIDER = "E0250", "a sound of impacts or sliding needs a collider on its body";
    ENDLESS = "E0252", "an infinite plane belongs to a moving body";
    TRIGGER = "E0251", "a trigger waits for impacts on a body without a collider";
    NO_TEXT = "E0260", "a label text is missing";
    BREATH = "E0261", "a recorded breath cannot be read";
    ATTRACT_ORDER = "E0262", "the attract script is out of order";
    UNKNOWN_TIMBRE = "E0263", "no timbre of this name";
    UNPLAYED = "E0264", "a timbre is not played by this motion";
    UNKNOWN_WIRE = "E0265", "no wire of this name";
    DYNAMICS_ONLY = "E0266", "an exhibit cannot move by positions";
    MIXED_KINDS = "E0267", "joined bodies move by different kinds of motion";
    UNKNOWN_SIGNAL = "E0268", "no signal of this name";
    EXPRESSION = "E0269", "a text is no expression";
    BROKEN_TIMBRE = "E0270", "a timbre of the exhibit is not valid";
    NO_FORCE = "E0271", "a timbre follows a force that its sound does not name";
    UNKNOWN_FINISH = "E0272", "no finish of this name";
    BROKEN_MODEL = "E0301", "the model is broken";
    EXTENSION = "E0302", "the model requires an extension that is not supported";
    MODEL_LIMIT = "E0303", "the model exceeds a limit";
    IMAGE = "E0304", "an image of the model cannot be decoded";
    CYCLE = "E0305", "the node tree of the model is not a tree";
    TRUNCATED = "E0306", "the file of the model is cut short";
    NOT_GLTF = "E0307", "the file is not glTF 2.0";
    MODEL_SIZE = "E0308", "a place or a scale of the model is beyond what a museum can hold";
    CONFIG = "E0501", "the site's configuration is invalid";
    SCENE = "E0502", "a physics scene is invalid";
    TEXTS = "E0503", "a file of the kiosk's own texts is invalid";
    NEW = "E0601", "a new exhibit cannot be made from this input";
    TABLE = "E0602", "a table of label texts cannot be merged";
    NO_CAPTION = "W0401", "a sound has no caption";
    MISSING_WORDS = "W0402", "a label is missing in a language";
    NO_ALT = "W0403", "a label has no description for visitors who cannot see";
    SKIPPED = "W0404", "a part of the model is not drawn";
    DUPLICATE_NODE = "W0406", "two nodes of the model have the same name";
    REDUNDANT = "W0407", "a freedom is constrained twice";
    GEAR_DISTANCE = "W0408", "the axles of two gears are not as far apart as their radii say";
    MASS_RATIO = "W0409", "two joined bodies differ in mass by more than a million";
    UNUSED = "W0410", "a value has no effect";
    LATE = "W0411", "a step misses its deadline";
    OLD_NAME = "W0412", "a key or a word has its old name";
    MISSING_TEXTS = "W0413", "a file of the kiosk's own texts lacks some, or leaves out a variable";
    MODEL_FORM = "W0414", "the model contradicts glTF 2.0, without effect here";
}
