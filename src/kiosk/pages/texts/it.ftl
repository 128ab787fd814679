# Italiano

language-name = Italiano

## What visitors read

invite = Soffia piano
hold = Tieni premuto per soffiare
no-breath = Oggi non si soffia: tieni premuto per fare vento
privacy = Il microfono misura solo l’aria. Non viene registrato nulla.
more = Altro
back = Torna all’opera
aim = Tocca o indica: l’anello mostra dove va il tuo soffio
take = Premi e trascina per muoverla con la mano
press-twice = Premi per soffiare, premi di nuovo per smettere
dwell-twice = Tieni fermo il puntatore per soffiare; spostalo e tienilo fermo di nuovo per smettere
look-round = Gira intorno
look-round-drag = Trascina accanto all’opera per girarle intorno
look-round-press = Premi accanto all’opera per girarle intorno
large-text = Testo grande
high-contrast = Contrasto elevato
microphone = Microfono
press-once = Un solo tocco
dwell = Puntare senza premere
less-motion = Meno movimento
read-aloud = Leggi ad alta voce
microphone-off = Il microfono è spento.
sound-off = L’audio è spento.
no-sound = Quest’opera è silenziosa.
take-a-rest = Fai una pausa e respira con calma.
stay = Tocca o soffia per continuare
stay-touch = Tocca per continuare
cleaning = Pulizia dello schermo in corso

## What is read aloud of buttons that show only a sign

louder = Più forte
softer = Più piano
next-page = Opere successive
previous-page = Opere precedenti
on = attivo
off = non attivo

## The staff panel: its frame

staff-page-status = Stato
staff-page-exhibits = Opere
staff-page-bodies = Corpi
staff-page-wind = Vento
staff-page-sound = Suono
staff-page-parameters = Parametri
staff-page-microphone = Microfono
staff-page-test = Prova
staff-page-log = Registro
staff-no-pin = Nessun PIN impostato: questo pannello mostra tutto e non cambia nulla. Esegui `soffio pin` e metti la riga che stampa sotto [staff].
staff-saved-in = Salvato in { $file }.
staff-enter-pin = Personale: inserire il PIN
staff-pin-checking = Verifica
staff-pin-wrong = { $count ->
    [one] PIN errato. Riprova tra { $seconds } s.
   *[other] PIN errato, { $count } volte di seguito. Riprova tra { $seconds } s.
}

## Staff: status

staff-clean = Pulire lo schermo
staff-mute = Muto
staff-unmute = Audio attivo
staff-night = Notte
staff-reset = Ripristina
staff-reload = Ricarica l’opera
staff-open-now = Apri ora
staff-close-again = Chiudi di nuovo
staff-audio-self-test = Autotest audio
staff-new-foam = Nuovo antivento
staff-new-reference = Nuovo riferimento
staff-end = Chiudi il programma
staff-configuration-says = Configurazione: { $message }
staff-microphone-says = Microfono: { $message }
staff-venue = museo
staff-venue-open = aperto
staff-venue-early = aperto dal personale prima dell’orario
staff-venue-closed = chiuso
staff-breath-wanted = soffio
staff-breath-allowed = permesso
staff-breath-off = disattivato: i visitatori tengono premuto
staff-exhibit = opera
staff-microphone = microfono
staff-microphone-dual = { $device }, doppio microfono
staff-device-starting = avvio
staff-device-ok = { $name }, { $rate } Hz
staff-device-missing = assente: { $reason }
staff-device-closed = chiuso
staff-level = livello
staff-level-floor = { $level } dBFS, rumore di fondo { $floor } dBFS
staff-no-signal = nessun segnale
staff-clipping = saturazione
staff-clips = { $count ->
    [one] { $count } volta, di cui { $without } senza soffio
   *[other] { $count } volte, di cui { $without } senza soffio
}
staff-foam = antivento
staff-foam-breaths = { $count ->
    [one] { $count } soffio
   *[other] { $count } soffi
}
staff-foam-breaths-of = { $count } su { $limit ->
    [one] { $limit } soffio
   *[other] { $limit } soffi
}
staff-self-test = autotest audio
staff-self-test-none = non ancora eseguito
staff-self-test-when = { $verdict }; { $when }
staff-self-test-good = antivento, altoparlante e microfono sono come prima ({ $db } dB)
staff-self-test-learning = misura di riferimento { $number } di { $count }
staff-self-test-wet-foam = antivento umido o impolverato: gli acuti sono più deboli di { $db } dB. Cambiarlo.
staff-self-test-blocked = tutto è più debole di { $db } dB: controllare antivento, ostacoli e guadagni
staff-self-test-louder = tutto è più forte di { $db } dB: un guadagno è stato alzato. Se è voluto, premere “Nuovo riferimento”.
staff-self-test-dead = nessun segnale dal microfono: controllare cavo, interruttore e alimentazione
staff-self-test-not-detected = il suono di prova non è arrivato: controllare l’altoparlante e il suo amplificatore
staff-self-test-noisy = la sala era troppo rumorosa per misurare
staff-self-test-failed = non eseguito: { $reason }
staff-gain-control = guadagno automatico
staff-gain-control-detected = rilevato
staff-gain-control-none = non rilevato
staff-heard = qui il rilevatore sente
staff-heard-of = { $detected } soffi su { $of } a { $distance } cm
staff-heard-unknown = non misurato: registrare dieci soffi, poi soffio breath fit
staff-gusts = correnti d’aria e porte
staff-gusts-cost = costano { $db } dB a un soffio
staff-detector = rilevatore
staff-detector-state = { $reason }, { $confidence }
staff-breath = soffio
staff-breath-speeds = { $detected } m/s rilevati, { $blown } m/s nell’aria
staff-reason-no-signal = nessun segnale
staff-reason-settling = apprende il rumore di fondo
staff-reason-quiet = silenzio
staff-reason-voiced = voce o musica
staff-reason-other-sound = non sembra un soffio
staff-reason-pending = forse un soffio
staff-reason-blow = soffio
staff-reason-masked = suono proprio del chiosco
staff-reason-fault = campioni errati
staff-wind-force = forza del vento
staff-attract = dimostrazione
staff-attract-playing = in corso
staff-attract-waiting = in attesa
staff-joint-error = errore dei giunti
staff-energy = energia
staff-substeps = sottopassi
staff-impacts = urti
staff-faults = guasti
staff-step = passo
staff-step-time = { $ms } ms di { $limit } ms
staff-motion = movimento
staff-motion-changes = { $count ->
    [one] { $mode }, { $count } cambio
   *[other] { $mode }, { $count } cambi
}
staff-motion-dynamics = dinamica vincolata
staff-motion-procedural = procedurale
staff-motion-position-based = per posizioni
staff-pointer-grabs = tenuto con la mano
staff-steps-dropped = passi saltati
staff-commands-dropped = comandi persi
staff-picture = immagine
staff-wind-to-picture = dal vento all’immagine
staff-graphics = grafica
staff-loudspeaker = altoparlante
staff-hearing-loop = anello magnetico
staff-step-to-sound = dal passo al suono
staff-sound-delay = { $total } ms: passo { $step }, blocco { $block }, limitatore { $limiter }, dispositivo { $device }
staff-sound-delay-unknown = { $total } ms: passo { $step }, blocco { $block }, limitatore { $limiter }, dispositivo sconosciuto
staff-block = blocco
staff-block-is = { $ms } ms, configurati { $wanted } ms
staff-block-shorter = { $ms } ms, configurati { $wanted } ms; audio.block_ms = { $possible } è possibile qui
staff-block-shortest = { $ms } ms, configurati { $wanted } ms; il più breve del dispositivo è { $shortest } ms
staff-late-blocks = blocchi in ritardo
staff-sounds-lost = suoni persi
staff-volume = volume
staff-volume-is = { $db } dB, scatti dei visitatori { $steps }
staff-volume-attenuated = { $volume }, attenuato di { $db } dB
staff-volume-muted = { $volume }, muto
staff-sound-of-the = modalità audio
staff-sound-day = giorno
staff-sound-night = notte
staff-sound-by-hours = { $mode }, secondo l’orario
staff-sound-by-staff = { $mode }, dal personale
staff-level-minute = livello, minuto
staff-level-day = livello, giorno
staff-level-calibrated = { $db } dB(A)
staff-level-uncalibrated = { $db } dB(A) di fondo scala, non calibrato
staff-level-silent = silenzio

## Staff: exhibits

staff-exhibits-order = I visitatori trovano le opere in quest’ordine.
staff-save-order = Salva l’ordine
staff-discard = Annulla
staff-no-file = La configurazione è incorporata: senza un file non si può salvare nulla.
staff-others = tutte le altre
staff-others-count = tutte le altre ({ $count })
staff-exhibit-missing = { $id } (assente o non caricabile: vedi il registro)
staff-not-listed = Non nell’elenco:

## Staff: bodies and joints

staff-largest-joint-error = errore massimo dei giunti
staff-no-data-yet = Ancora nessun dato dalla simulazione
staff-joints = Giunti; premerne uno per vederne la curva
staff-column-body = corpo
staff-column-mass = massa, g
staff-column-speed = velocità, m/s
staff-column-spin = rotazione, rad/s
staff-column-height = altezza, m

## Staff: wind

staff-wind-help = Ogni punto è una porzione di superficie che sente il vento. Un anello segna le porzioni dentro il cono del soffio così come è puntato ora e visibili dalle labbra. Più è rosso, più l’aria è veloce.
staff-column-surface = superficie di
staff-column-hit = colpite
staff-column-mean = media, m/s
staff-column-fastest = massima, m/s
staff-hit-of = { $hit } su { $count }
staff-total-force = forza totale del vento: { $newtons } N
staff-source-speed = soffio alla sorgente: { $speed } m/s

## Staff: sound

staff-nothing-audible = Non si sentirà nulla: audio muto o nessun altoparlante
staff-strike-speed = velocità del colpo, m/s
staff-pan = sinistra … destra
staff-all-timbres = Tutti i timbri, ciascuno sul suo corpo di prova

## Staff: parameters

staff-does-not-load = Il file salvato non si carica; è mostrata l’ultima versione valida. Annullare la modifica o correggerla:
staff-parameters-help = { $file }. Trascinare un numero, oppure premerlo e digitare; viene salvato al rilascio.
staff-undo = Annulla ({ $count })
staff-undone = Annullato.
staff-find = cerca
staff-saved-value = Salvato: { $value }.

## Staff: microphone

staff-no-signal-from = Nessun segnale; { $device }
staff-level-now = livello attuale
staff-level-range = dall’apertura della pagina
staff-from-to = da { $low } a { $high } dBFS
staff-noise-floor = rumore di fondo
staff-breath-at-lips = soffio alle labbra
staff-microphones = microfoni
staff-all-well = Nulla da correggere.
staff-measure-again = Misura di nuovo l’intervallo
staff-sensitivity = breath.sensitivity_db: quanto vale un soffio
staff-calibrate = Calibra con un soffio
staff-calibrate-blow = { $count ->
    [one] Dal posto dei visitatori, soffiare verso il microfono come loro per uno o due secondi, ancora una volta.
   *[other] Dal posto dei visitatori, soffiare verso il microfono come loro per uno o due secondi, ancora { $count } volte.
}
staff-stop = Ferma
staff-calibrated = Se erano soffi normali: { $proposed } dB invece di { $now } dB.
staff-apply = Applica
staff-dismiss = Ignora
staff-remedy-gain-control = Disattivare il guadagno automatico: nel mixer del sistema (“Auto Gain”, “AGC”), nel software del microfono o sul dispositivo.
staff-remedy-clipping = Satura: abbassare il guadagno d’ingresso.
staff-remedy-muted = È muto: aprire l’ingresso nel mixer del sistema.
staff-remedy-loud = Forte per una sala tranquilla: abbassare il guadagno d’ingresso.

## Staff: test

staff-glass = Schermo tattile
staff-glass-help = { $count ->
    [one] Premere l’immagine con un dito o più: un anello segue ciascuno. Ora: { $count } dito.
   *[other] Premere l’immagine con un dito o più: un anello segue ciascuno. Ora: { $count } dita.
}
staff-clear-traces = Cancella le tracce
staff-display = Schermo
staff-display-help = Livelli di grigio, bordi, poi colori che rivelano i pixel difettosi. Ogni tocco mostra l’immagine seguente.
staff-show-patterns = Mostra le immagini di prova
staff-loudspeakers = Altoparlanti
staff-left = Sinistra
staff-both = Entrambi
staff-right = Destra
staff-decision = decisione
staff-decision-breath = soffio
staff-decision-none = nessun soffio
staff-because = motivo
staff-confidence = sicurezza
staff-speed = velocità
staff-grey-steps = 17 livelli uniformi; cinque quadrati sono visibili nel nero e nel bianco
staff-edges = una linea bianca di un pixel su tutti e quattro i bordi; cinque cerchi rotondi

## Staff: log

staff-log-grave = solo avvisi ed errori
staff-log-empty = nessuna riga
