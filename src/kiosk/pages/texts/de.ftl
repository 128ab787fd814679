# Deutsch

language-name = Deutsch

## What visitors read

invite = Sanft pusten
hold = Zum Pusten gedrückt halten
no-breath = Heute bitte nicht pusten: Gedrückt halten macht Wind
privacy = Das Mikrofon misst nur den Luftstrom. Nichts wird aufgezeichnet.
more = Mehr
back = Zurück zum Werk
aim = Berühren oder zeigen: Der Ring zeigt, wohin dein Atem geht
take = Drücken und ziehen: So bewegst du es mit der Hand
press-twice = Drücken zum Pusten, noch einmal drücken zum Aufhören
dwell-twice = Zeiger ruhen lassen zum Pusten; bewegen und wieder ruhen lassen zum Aufhören
look-round = Rundum ansehen
look-round-drag = Neben dem Werk ziehen, um es rundum anzusehen
look-round-press = Neben das Werk drücken, um es rundum anzusehen
large-text = Große Schrift
high-contrast = Hoher Kontrast
microphone = Mikrofon
press-once = Einmal drücken
dwell = Verweilen statt drücken
less-motion = Weniger Bewegung
read-aloud = Vorlesen
microphone-off = Das Mikrofon ist aus.
sound-off = Der Ton ist aus.
no-sound = Dieses Werk ist lautlos.
take-a-rest = Mach eine Pause und atme ruhig.
stay = Zum Weitermachen berühren oder pusten
stay-touch = Zum Weitermachen berühren
cleaning = Der Bildschirm wird gereinigt

## What is read aloud of buttons that show only a sign

louder = Lauter
softer = Leiser
next-page = Weitere Werke
previous-page = Vorherige Werke
on = ein
off = aus

## The staff panel: its frame

staff-page-status = Status
staff-page-exhibits = Exponate
staff-page-bodies = Körper
staff-page-wind = Wind
staff-page-sound = Klang
staff-page-parameters = Parameter
staff-page-microphone = Mikrofon
staff-page-test = Test
staff-page-log = Protokoll
staff-no-pin = Es ist keine PIN gesetzt: Die Konsole zeigt alles und ändert nichts. `soffio pin` gibt eine Zeile aus, die unter [staff] gehört.
staff-saved-in = Gespeichert in { $file }.
staff-enter-pin = Personal: PIN eingeben
staff-pin-checking = Wird geprüft
staff-pin-wrong = { $count ->
    [one] Falsche PIN. Neuer Versuch in { $seconds } s.
   *[other] Falsche PIN, { $count }-mal in Folge. Neuer Versuch in { $seconds } s.
}

## Staff: status

staff-clean = Bildschirm reinigen
staff-mute = Stumm
staff-unmute = Ton an
staff-night = Nacht
staff-reset = Zurücksetzen
staff-reload = Exponat neu laden
staff-open-now = Jetzt öffnen
staff-close-again = Wieder schließen
staff-audio-self-test = Audio-Selbsttest
staff-new-foam = Neuer Windschutz
staff-new-reference = Neue Referenz
staff-end = Kiosk beenden
staff-configuration-says = Konfiguration: { $message }
staff-microphone-says = Mikrofon: { $message }
staff-venue = Museum
staff-venue-open = geöffnet
staff-venue-early = vom Personal vor den Öffnungszeiten geöffnet
staff-venue-closed = geschlossen
staff-breath-wanted = Pusten
staff-breath-allowed = erlaubt
staff-breath-off = aus: Besucher halten gedrückt
staff-exhibit = Exponat
staff-microphone = Mikrofon
staff-microphone-dual = { $device }, Doppelmikrofon
staff-device-starting = startet
staff-device-ok = { $name }, { $rate } Hz
staff-device-missing = fehlt: { $reason }
staff-device-closed = geschlossen
staff-level = Pegel
staff-level-floor = { $level } dBFS, Grundrauschen { $floor } dBFS
staff-no-signal = kein Signal
staff-clipping = Übersteuerung
staff-clips = { $count ->
    [one] { $count }-mal, davon { $without } ohne Atem
   *[other] { $count }-mal, davon { $without } ohne Atem
}
staff-foam = Windschutz
staff-foam-breaths = { $count ->
    [one] { $count } Atemstoß
   *[other] { $count } Atemstöße
}
staff-foam-breaths-of = { $count } von { $limit ->
    [one] { $limit } Atemstoß
   *[other] { $limit } Atemstößen
}
staff-self-test = Audio-Selbsttest
staff-self-test-none = noch nicht gelaufen
staff-self-test-when = { $verdict }; { $when }
staff-self-test-good = Windschutz, Lautsprecher und Mikrofon sind wie zuvor ({ $db } dB)
staff-self-test-learning = Referenzmessung { $number } von { $count }
staff-self-test-wet-foam = Windschutz feucht oder staubig: hohe Töne sind { $db } dB leiser. Bitte wechseln.
staff-self-test-blocked = alles ist { $db } dB leiser: Windschutz, Hindernisse und Verstärkung prüfen
staff-self-test-louder = alles ist { $db } dB lauter: eine Verstärkung wurde erhöht. War es Absicht, „Neue Referenz“ drücken.
staff-self-test-dead = kein Signal vom Mikrofon: Kabel, Schalter und Stromversorgung prüfen
staff-self-test-not-detected = der Testton kam nicht an: Lautsprecher und Verstärker prüfen
staff-self-test-noisy = im Raum war es für die Messung zu laut
staff-self-test-failed = nicht gelaufen: { $reason }
staff-gain-control = automatische Verstärkung
staff-gain-control-detected = erkannt
staff-gain-control-none = nicht erkannt
staff-heard = hier hört der Detektor
staff-heard-of = { $detected } von { $of } Atemstößen aus { $distance } cm
staff-heard-unknown = nicht gemessen: zehn Atemstöße aufnehmen, dann soffio breath fit
staff-gusts = Zugluft und Türen
staff-gusts-cost = kosten einen Atemstoß { $db } dB
staff-detector = Detektor
staff-detector-state = { $reason }, { $confidence }
staff-breath = Atem
staff-breath-speeds = { $detected } m/s erkannt, { $blown } m/s in der Luft
staff-reason-no-signal = kein Signal
staff-reason-settling = lernt das Grundrauschen
staff-reason-quiet = still
staff-reason-voiced = Stimme oder Musik
staff-reason-other-sound = klingt nicht wie Atem
staff-reason-pending = vielleicht Atem
staff-reason-blow = Atem
staff-reason-masked = eigener Ton des Kiosks
staff-reason-fault = fehlerhafte Messwerte
staff-wind-force = Windkraft
staff-attract = Vorführung
staff-attract-playing = läuft
staff-attract-waiting = wartet
staff-joint-error = Gelenkfehler
staff-energy = Energie
staff-substeps = Teilschritte
staff-impacts = Stöße
staff-faults = Fehler
staff-step = Schritt
staff-step-time = { $ms } ms von { $limit } ms
staff-motion = Bewegung
staff-motion-changes = { $count ->
    [one] { $mode }, { $count } Wechsel
   *[other] { $mode }, { $count } Wechsel
}
staff-motion-dynamics = Dynamik mit Zwangsbedingungen
staff-motion-procedural = prozedural
staff-motion-position-based = positionsbasiert
staff-pointer-grabs = mit der Hand gehalten
staff-steps-dropped = ausgelassene Schritte
staff-commands-dropped = verlorene Befehle
staff-picture = Bild
staff-wind-to-picture = Wind bis Bild
staff-graphics = Grafik
staff-loudspeaker = Lautsprecher
staff-hearing-loop = Induktionsschleife
staff-step-to-sound = Schritt bis Ton
staff-sound-delay = { $total } ms: Schritt { $step }, Block { $block }, Limiter { $limiter }, Gerät { $device }
staff-sound-delay-unknown = { $total } ms: Schritt { $step }, Block { $block }, Limiter { $limiter }, Gerät unbekannt
staff-block = Block
staff-block-is = { $ms } ms, eingestellt { $wanted } ms
staff-block-shorter = { $ms } ms, eingestellt { $wanted } ms; audio.block_ms = { $possible } ist hier möglich
staff-block-shortest = { $ms } ms, eingestellt { $wanted } ms; der kürzeste des Geräts ist { $shortest } ms
staff-late-blocks = verspätete Blöcke
staff-sounds-lost = verlorene Klänge
staff-volume = Lautstärke
staff-volume-is = { $db } dB, Stufen der Besucher { $steps }
staff-volume-attenuated = { $volume }, um { $db } dB gedämpft
staff-volume-muted = { $volume }, stumm
staff-sound-of-the = Tonmodus
staff-sound-day = Tag
staff-sound-night = Nacht
staff-sound-by-hours = { $mode }, nach Uhrzeit
staff-sound-by-staff = { $mode }, vom Personal
staff-level-minute = Pegel, Minute
staff-level-day = Pegel, Tag
staff-level-calibrated = { $db } dB(A)
staff-level-uncalibrated = { $db } dB(A) unter Vollaussteuerung, nicht kalibriert
staff-level-silent = still

## Staff: exhibits

staff-exhibits-order = In dieser Reihenfolge finden Besucher die Exponate.
staff-save-order = Reihenfolge speichern
staff-discard = Verwerfen
staff-no-file = Die Konfiguration ist eingebaut: Ohne Datei lässt sich nichts speichern.
staff-others = alle anderen
staff-others-count = alle anderen ({ $count })
staff-exhibit-missing = { $id } (fehlt oder lädt nicht: siehe Protokoll)
staff-not-listed = Nicht in der Liste:

## Staff: bodies and joints

staff-largest-joint-error = größter Gelenkfehler
staff-no-data-yet = Noch keine Daten von der Simulation
staff-joints = Gelenke; eines drücken zeigt seine Kurve
staff-column-body = Körper
staff-column-mass = Masse, g
staff-column-speed = Tempo, m/s
staff-column-spin = Drehung, rad/s
staff-column-height = Höhe, m

## Staff: wind

staff-wind-help = Jeder Punkt ist ein Flächenstück, das den Wind spürt. Ein Ring markiert Stücke, die im Kegel des Atems liegen, wie er jetzt zielt, und von den Lippen aus zu sehen sind. Je röter, desto schneller die Luft.
staff-column-surface = Fläche von
staff-column-hit = getroffen
staff-column-mean = Mittel, m/s
staff-column-fastest = größte, m/s
staff-hit-of = { $hit } von { $count }
staff-total-force = gesamte Windkraft: { $newtons } N
staff-source-speed = Atem an der Quelle: { $speed } m/s

## Staff: sound

staff-nothing-audible = Es wird nichts zu hören sein: stumm, oder kein Lautsprecher
staff-strike-speed = Anschlag, m/s
staff-pan = links … rechts
staff-all-timbres = Alle Klangfarben, jede an ihrem Testkörper

## Staff: parameters

staff-does-not-load = Die gespeicherte Datei lädt nicht; die letzte gute Fassung ist zu sehen. Änderung rückgängig machen oder korrigieren:
staff-parameters-help = { $file }. Eine Zahl ziehen, oder drücken und tippen; beim Loslassen wird gespeichert.
staff-undo = Rückgängig ({ $count })
staff-undone = Rückgängig gemacht.
staff-find = suchen
staff-saved-value = Gespeichert: { $value }.

## Staff: microphone

staff-no-signal-from = Kein Signal; { $device }
staff-level-now = Pegel jetzt
staff-level-range = seit dem Öffnen der Seite
staff-from-to = { $low } bis { $high } dBFS
staff-noise-floor = Grundrauschen
staff-breath-at-lips = Atem an den Lippen
staff-microphones = Mikrofone
staff-all-well = Nichts zu verbessern.
staff-measure-again = Bereich neu messen
staff-sensitivity = breath.sensitivity_db: wie stark ein Atemstoß zählt
staff-calibrate = Mit Atem kalibrieren
staff-calibrate-blow = { $count ->
    [one] Von dort, wo Besucher stehen, ein bis zwei Sekunden lang wie sie ins Mikrofon pusten, noch einmal.
   *[other] Von dort, wo Besucher stehen, ein bis zwei Sekunden lang wie sie ins Mikrofon pusten, noch { $count }-mal.
}
staff-stop = Abbrechen
staff-calibrated = Waren das normale Atemstöße: { $proposed } dB statt { $now } dB.
staff-apply = Übernehmen
staff-dismiss = Verwerfen
staff-remedy-gain-control = Automatische Verstärkung abschalten: im Mischer des Systems („Auto Gain“, „AGC“), in der Software des Mikrofons oder am Gerät.
staff-remedy-clipping = Es übersteuert: Eingangsverstärkung verringern.
staff-remedy-muted = Es ist stummgeschaltet: Eingang im Mischer des Systems öffnen.
staff-remedy-loud = Laut für einen ruhigen Raum: Eingangsverstärkung verringern.

## Staff: test

staff-glass = Bildschirm
staff-glass-help = { $count ->
    [one] Das Bild mit einem oder mehreren Fingern drücken: Jedem folgt ein Ring. Jetzt { $count } Finger.
   *[other] Das Bild mit einem oder mehreren Fingern drücken: Jedem folgt ein Ring. Jetzt { $count } Finger.
}
staff-clear-traces = Spuren löschen
staff-display = Anzeige
staff-display-help = Graustufen, Kanten, dann Farben, die tote Pixel zeigen. Jeder Druck führt zum nächsten Bild.
staff-show-patterns = Testbilder zeigen
staff-loudspeakers = Lautsprecher
staff-left = Links
staff-both = Beide
staff-right = Rechts
staff-decision = Entscheidung
staff-decision-breath = Atem
staff-decision-none = kein Atem
staff-because = Grund
staff-confidence = Sicherheit
staff-speed = Tempo
staff-grey-steps = 17 gleichmäßige Stufen; im Schwarz und im Weiß sind je fünf Quadrate zu sehen
staff-edges = eine weiße, ein Pixel breite Linie an allen vier Kanten; fünf runde Kreise

## Staff: log

staff-log-grave = nur Warnungen und Fehler
staff-log-empty = keine Zeilen
