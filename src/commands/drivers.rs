//! Graphics drivers that write to the terminal.
//!
//! Mesa's Vulkan layer `VK_LAYER_MESA_device_select` asks the Wayland compositor which graphics card is its own. Where
//! `XDG_RUNTIME_DIR` is not set there can be no compositor, and its client library writes an error for each list of cards,
//! twice in a run. The layer is switched off by a variable of its environment (its manifest names it), which has to be set
//! before the program starts. So the program starts itself again in its place, with the same process number.

use std::ffi::OsStr;
#[cfg(unix)]
use std::os::unix::process::CommandExt;

/// Folder of a user's session.
const SESSION: &str = "XDG_RUNTIME_DIR";
/// Switches the layer off.
const NO_SELECTION: &str = "NODEVICE_SELECT";

/// Does the layer have nothing to ask, and is it still on?
fn would_complain(session: Option<&OsStr>, no_selection: Option<&OsStr>) -> bool {
    session.is_none_or(OsStr::is_empty) && no_selection.is_none()
}

/// Switches the layer off where it would complain. If that fails, the program goes on, and the layer writes its lines.
pub fn keep_quiet() {
    #[cfg(unix)]
    if would_complain(std::env::var_os(SESSION).as_deref(), std::env::var_os(NO_SELECTION).as_deref())
        && let Ok(program) = std::env::current_exe()
    {
        let mut arguments = std::env::args_os();
        let name = arguments.next().unwrap_or_else(|| program.clone().into());
        // Returns only if it fails.
        let _ = std::process::Command::new(program).arg0(name).args(arguments).env(NO_SELECTION, "1").exec();
    }
}
