# The kiosk's own texts in English, which stand in wherever another language lacks one.
# A label's texts belong to its exhibit (exhibit.toml). How a museum changes one text or adds a language:
# kiosk-config/README.md. Names in braces, such as { $count }, are filled in by the kiosk.

# The language's name in the language.
language-name = English

## What visitors read

# Invites to blow; an exhibit's own text "invite" goes before it.
invite = Blow gently
# Invites where there is no microphone; an exhibit's own text "hold" goes before it.
hold = Press and hold to blow
# Invites where nobody may blow, in times of an outbreak.
no-breath = Today without breath: press and hold to blow
# Becomes of the sound that the microphone picks up.
privacy = The microphone measures air. Nothing is recorded.
# Opens the page with everything else, and leads back from it.
more = More
back = Back to the work
# How to aim, and how to pull the work.
aim = Touch or point: the ring shows where your breath goes
take = Press and drag to move it by hand
# How to blow with single presses, and by resting the pointer.
press-twice = Press to blow, press again to stop
dwell-twice = Rest the pointer to blow; move it and rest again to stop
# Looking round the work: the switch, and how to do it.
look-round = Look round
look-round-drag = Drag beside the work to look round it
look-round-press = Press beside the work to look round it
# Other switches.
large-text = Large text
high-contrast = High contrast
microphone = Microphone
press-once = Press once
dwell = Rest to press
less-motion = Less motion
read-aloud = Read aloud
# Notes beside the label.
microphone-off = The microphone is off.
sound-off = The sound is off.
no-sound = This work makes no sound.
# After much hard blowing, which makes light-headed.
take-a-rest = Take a rest and breathe calmly.
# How to stay when nobody seems to be there.
stay = Touch or blow to stay
stay-touch = Touch to stay
# Covers the picture while staff clean the glass.
cleaning = The glass is being cleaned

## What is read aloud of buttons that show only a sign

louder = Louder
softer = Softer
next-page = More works
previous-page = Previous works
on = on
off = off

## The staff panel: its frame

staff-page-status = Status
staff-page-exhibits = Exhibits
staff-page-bodies = Bodies
staff-page-wind = Wind
staff-page-sound = Sound
staff-page-parameters = Parameters
staff-page-microphone = Microphone
staff-page-test = Test
staff-page-log = Log
staff-no-pin = No PIN is set: this panel shows everything and changes nothing. Run `soffio pin` and put the line it prints under [staff].
staff-saved-in = Saved in { $file }.
staff-enter-pin = Staff: enter the PIN
staff-pin-checking = Checking
staff-pin-wrong = { $count ->
    [one] Wrong PIN. Try again in { $seconds } s.
   *[other] Wrong PIN, { $count } times in a row. Try again in { $seconds } s.
}

## Staff: status

staff-clean = Clean the glass
staff-mute = Mute
staff-unmute = Sound on
staff-night = Night
staff-reset = Reset
staff-reload = Reload exhibit
staff-open-now = Open now
staff-close-again = Close again
staff-audio-self-test = Audio self-test
staff-new-foam = New foam
staff-new-reference = New reference
staff-end = End the kiosk
staff-configuration-says = Configuration: { $message }
staff-microphone-says = Microphone: { $message }
staff-venue = museum
staff-venue-open = open
staff-venue-early = open, by staff, before its hours
staff-venue-closed = closed
staff-breath-wanted = breath
staff-breath-allowed = allowed
staff-breath-off = off: visitors press and hold
staff-exhibit = exhibit
staff-microphone = microphone
staff-microphone-dual = { $device }, dual microphone
staff-device-starting = starting
staff-device-ok = { $name }, { $rate } Hz
staff-device-missing = missing: { $reason }
staff-device-closed = closed
staff-level = level
staff-level-floor = { $level } dBFS, noise floor { $floor } dBFS
staff-no-signal = no signal
staff-clipping = clipping
staff-clips = { $count ->
    [one] { $count } time, { $without } without a breath
   *[other] { $count } times, { $without } without a breath
}
staff-foam = foam
staff-foam-breaths = { $count ->
    [one] { $count } breath
   *[other] { $count } breaths
}
staff-foam-breaths-of = { $count } of { $limit ->
    [one] { $limit } breath
   *[other] { $limit } breaths
}
staff-self-test = audio self-test
staff-self-test-none = not run yet
staff-self-test-when = { $verdict }; { $when }
staff-self-test-good = foam, loudspeaker and microphone are as before ({ $db } dB)
staff-self-test-learning = reference measurement { $number } of { $count }
staff-self-test-wet-foam = wet or dusty foam: high tones are { $db } dB softer. Change the foam.
staff-self-test-blocked = everything is { $db } dB softer: check the foam, obstacles and gains
staff-self-test-louder = everything is { $db } dB louder: a gain was turned up. If on purpose, press “New reference”.
staff-self-test-dead = no signal from the microphone: check its cable, switch and power
staff-self-test-not-detected = the test sound did not arrive: check the loudspeaker and its amplifier
staff-self-test-noisy = the gallery was too loud to measure
staff-self-test-failed = not run: { $reason }
staff-gain-control = automatic gain control
staff-gain-control-detected = detected
staff-gain-control-none = not detected
staff-heard = here the detector hears
staff-heard-of = { $detected } of { $of } breaths at { $distance } cm
staff-heard-unknown = not measured: record ten breaths, then run soffio breath fit
staff-gusts = draughts and doors
staff-gusts-cost = cost a breath { $db } dB
staff-detector = detector
staff-detector-state = { $reason }, { $confidence }
staff-breath = breath
staff-breath-speeds = { $detected } m/s detected, { $blown } m/s in the air
staff-reason-no-signal = no signal
staff-reason-settling = learning the noise floor
staff-reason-quiet = quiet
staff-reason-voiced = voice or music
staff-reason-other-sound = not like breath
staff-reason-pending = perhaps a breath
staff-reason-blow = breath
staff-reason-masked = the kiosk's own sound
staff-reason-fault = faulty samples
staff-wind-force = wind force
staff-attract = attract mode
staff-attract-playing = playing
staff-attract-waiting = waiting
staff-joint-error = joint error
staff-energy = energy
staff-substeps = substeps
staff-impacts = impacts
staff-faults = faults
staff-step = step
staff-step-time = { $ms } ms of { $limit } ms
staff-motion = motion
staff-motion-changes = { $count ->
    [one] { $mode }, { $count } change
   *[other] { $mode }, { $count } changes
}
staff-motion-dynamics = constrained dynamics
staff-motion-procedural = procedural
staff-motion-position-based = position-based
staff-pointer-grabs = held by hand
staff-steps-dropped = steps dropped
staff-commands-dropped = commands dropped
staff-picture = picture
staff-wind-to-picture = wind to picture
staff-graphics = graphics
staff-loudspeaker = loudspeaker
staff-hearing-loop = hearing loop
staff-step-to-sound = step to sound
staff-sound-delay = { $total } ms: step { $step }, block { $block }, limiter { $limiter }, device { $device }
staff-sound-delay-unknown = { $total } ms: step { $step }, block { $block }, limiter { $limiter }, device unknown
staff-block = block
staff-block-is = { $ms } ms, { $wanted } ms configured
staff-block-shorter = { $ms } ms, { $wanted } ms configured; audio.block_ms = { $possible } is possible here
staff-block-shortest = { $ms } ms, { $wanted } ms configured; the device's shortest is { $shortest } ms
staff-late-blocks = late blocks
staff-sounds-lost = sounds lost
staff-volume = volume
staff-volume-is = { $db } dB, visitors’ steps { $steps }
staff-volume-attenuated = { $volume }, attenuated by { $db } dB
staff-volume-muted = { $volume }, muted
staff-sound-of-the = sound mode
staff-sound-day = day
staff-sound-night = night
staff-sound-by-hours = { $mode }, by the hours
staff-sound-by-staff = { $mode }, by staff
staff-level-minute = level, minute
staff-level-day = level, day
staff-level-calibrated = { $db } dB(A)
staff-level-uncalibrated = { $db } dB(A) of full scale, not calibrated
staff-level-silent = silent

## Staff: exhibits

staff-exhibits-order = Visitors find the exhibits in this order.
staff-save-order = Save the order
staff-discard = Discard
staff-no-file = The configuration is built in: without a file nothing can be saved.
staff-others = all others
staff-others-count = all others ({ $count })
staff-exhibit-missing = { $id } (missing, or it does not load: see the log)
staff-not-listed = Not in the list:

## Staff: bodies and joints

staff-largest-joint-error = largest joint error
staff-no-data-yet = No data from the simulation yet
staff-joints = Joints; press one for its curve
staff-column-body = body
staff-column-mass = mass, g
staff-column-speed = speed, m/s
staff-column-spin = spin, rad/s
staff-column-height = height, m

## Staff: wind

staff-wind-help = Each dot is a patch that feels the wind. A ring marks patches inside the breath's cone as it is aimed now and visible from the lips. The redder, the faster the air.
staff-column-surface = surface of
staff-column-hit = hit
staff-column-mean = mean, m/s
staff-column-fastest = fastest, m/s
staff-hit-of = { $hit } of { $count }
staff-total-force = total wind force: { $newtons } N
staff-source-speed = breath at its source: { $speed } m/s

## Staff: sound

staff-nothing-audible = Nothing will be audible: muted, or no loudspeaker
staff-strike-speed = strike speed, m/s
staff-pan = left … right
staff-all-timbres = All timbres, each on its test body

## Staff: parameters

staff-does-not-load = The saved file does not load; the last good version is on show. Undo the change, or correct it:
staff-parameters-help = { $file }. Drag a number, or press it and type; it is saved when you let go.
staff-undo = Undo ({ $count })
staff-undone = Undone.
staff-find = find
staff-saved-value = Saved: { $value }.

## Staff: microphone

staff-no-signal-from = No signal; { $device }
staff-level-now = level now
staff-level-range = since the page opened
staff-from-to = { $low } to { $high } dBFS
staff-noise-floor = noise floor
staff-breath-at-lips = breath at the lips
staff-microphones = microphones
staff-all-well = Nothing to correct.
staff-measure-again = Measure the range again
staff-sensitivity = breath.sensitivity_db: how strong a breath counts
staff-calibrate = Calibrate with a breath
staff-calibrate-blow = { $count ->
    [one] From where visitors stand, blow at the microphone as they would for a second or two, once more.
   *[other] From where visitors stand, blow at the microphone as they would for a second or two, { $count } times more.
}
staff-stop = Stop
staff-calibrated = If those were normal breaths: { $proposed } dB instead of { $now } dB.
staff-apply = Apply
staff-dismiss = Dismiss
staff-remedy-gain-control = Switch off automatic gain control: in the system's mixer (“Auto Gain”, “AGC”), in the microphone's own software, or on the device.
staff-remedy-clipping = It clips: turn the input gain down.
staff-remedy-muted = It is muted: open the input in the system's mixer.
staff-remedy-loud = Loud for a quiet gallery: turn the input gain down.

## Staff: test

staff-glass = Glass
staff-glass-help = { $count ->
    [one] Press the picture with one finger or several: a ring follows each. { $count } is down now.
   *[other] Press the picture with one finger or several: a ring follows each. { $count } are down now.
}
staff-clear-traces = Clear the traces
staff-display = Display
staff-display-help = Grey steps, edges, then colours that reveal dead pixels. Each press shows the next.
staff-show-patterns = Show test pictures
staff-loudspeakers = Loudspeakers
staff-left = Left
staff-both = Both
staff-right = Right
staff-decision = decision
staff-decision-breath = a breath
staff-decision-none = no breath
staff-because = reason
staff-confidence = confidence
staff-speed = speed
staff-grey-steps = 17 even steps; five squares are visible in the black and in the white
staff-edges = a white line one pixel wide on all four edges; five round circles

## Staff: log

staff-log-grave = only warnings and errors
staff-log-empty = no lines
