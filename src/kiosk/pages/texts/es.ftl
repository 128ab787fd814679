# Español

language-name = Español

## What visitors read

invite = Sopla suavemente
hold = Mantén pulsado para soplar
no-breath = Hoy no se sopla: mantén pulsado para hacer viento
privacy = El micrófono solo mide el aire. No se graba nada.
more = Más
back = Volver a la obra
aim = Toca o señala: el anillo muestra adónde va tu soplo
take = Pulsa y arrastra para moverla con la mano
press-twice = Pulsa para soplar, pulsa de nuevo para parar
dwell-twice = Deja quieto el puntero para soplar; muévelo y déjalo quieto de nuevo para parar
look-round = Mirar alrededor
look-round-drag = Arrastra junto a la obra para verla desde otro lado
look-round-press = Pulsa junto a la obra para verla desde otro lado
large-text = Texto grande
high-contrast = Alto contraste
microphone = Micrófono
press-once = Pulsar una vez
dwell = Apuntar sin pulsar
less-motion = Menos movimiento
read-aloud = Leer en voz alta
microphone-off = El micrófono está apagado.
sound-off = El sonido está apagado.
no-sound = Esta obra no tiene sonido.
take-a-rest = Descansa un poco y respira con calma.
stay = Toca o sopla para seguir
stay-touch = Toca para seguir
cleaning = Limpieza de la pantalla en curso

## What is read aloud of buttons that show only a sign

louder = Más alto
softer = Más bajo
next-page = Obras siguientes
previous-page = Obras anteriores
on = activado
off = desactivado

## The staff panel: its frame

staff-page-status = Estado
staff-page-exhibits = Obras
staff-page-bodies = Cuerpos
staff-page-wind = Viento
staff-page-sound = Sonido
staff-page-parameters = Parámetros
staff-page-microphone = Micrófono
staff-page-test = Prueba
staff-page-log = Registro
staff-no-pin = No hay ningún PIN: este panel lo muestra todo y no cambia nada. Ejecute `soffio pin` y ponga la línea que imprime bajo [staff].
staff-saved-in = Guardado en { $file }.
staff-enter-pin = Personal: introduzca el PIN
staff-pin-checking = Comprobando
staff-pin-wrong = { $count ->
    [one] PIN incorrecto. Nuevo intento en { $seconds } s.
   *[other] PIN incorrecto, { $count } veces seguidas. Nuevo intento en { $seconds } s.
}

## Staff: status

staff-clean = Limpiar la pantalla
staff-mute = Silenciar
staff-unmute = Activar el sonido
staff-night = Noche
staff-reset = Restablecer
staff-reload = Recargar la obra
staff-open-now = Abrir ahora
staff-close-again = Cerrar de nuevo
staff-audio-self-test = Autoprueba de audio
staff-new-foam = Espuma nueva
staff-new-reference = Nueva referencia
staff-end = Cerrar el programa
staff-configuration-says = Configuración: { $message }
staff-microphone-says = Micrófono: { $message }
staff-venue = museo
staff-venue-open = abierto
staff-venue-early = abierto por el personal antes de su hora
staff-venue-closed = cerrado
staff-breath-wanted = soplo
staff-breath-allowed = permitido
staff-breath-off = desactivado: los visitantes mantienen pulsado
staff-exhibit = obra
staff-microphone = micrófono
staff-microphone-dual = { $device }, micrófono doble
staff-device-starting = iniciando
staff-device-ok = { $name }, { $rate } Hz
staff-device-missing = falta: { $reason }
staff-device-closed = cerrado
staff-level = nivel
staff-level-floor = { $level } dBFS, ruido de fondo { $floor } dBFS
staff-no-signal = sin señal
staff-clipping = saturación
staff-clips = { $count ->
    [one] { $count } vez, { $without } sin soplo
   *[other] { $count } veces, { $without } sin soplo
}
staff-foam = espuma
staff-foam-breaths = { $count ->
    [one] { $count } soplo
   *[other] { $count } soplos
}
staff-foam-breaths-of = { $count } de { $limit ->
    [one] { $limit } soplo
   *[other] { $limit } soplos
}
staff-self-test = autoprueba de audio
staff-self-test-none = aún no realizada
staff-self-test-when = { $verdict }; { $when }
staff-self-test-good = espuma, altavoz y micrófono están como antes ({ $db } dB)
staff-self-test-learning = medida de referencia { $number } de { $count }
staff-self-test-wet-foam = espuma húmeda o con polvo: los agudos son { $db } dB más débiles. Cámbiela.
staff-self-test-blocked = todo es { $db } dB más débil: revise la espuma, los obstáculos y las ganancias
staff-self-test-louder = todo es { $db } dB más fuerte: se subió una ganancia. Si fue a propósito, pulse «Nueva referencia».
staff-self-test-dead = sin señal del micrófono: revise su cable, interruptor y alimentación
staff-self-test-not-detected = el sonido de prueba no llegó: revise el altavoz y su amplificador
staff-self-test-noisy = la sala estaba demasiado ruidosa para medir
staff-self-test-failed = no realizada: { $reason }
staff-gain-control = ganancia automática
staff-gain-control-detected = detectada
staff-gain-control-none = no detectada
staff-heard = aquí el detector oye
staff-heard-of = { $detected } de { $of } soplos a { $distance } cm
staff-heard-unknown = sin medir: grabe diez soplos y ejecute soffio breath fit
staff-gusts = corrientes de aire y puertas
staff-gusts-cost = cuestan { $db } dB a un soplo
staff-detector = detector
staff-detector-state = { $reason }, { $confidence }
staff-breath = soplo
staff-breath-speeds = { $detected } m/s detectados, { $blown } m/s en el aire
staff-reason-no-signal = sin señal
staff-reason-settling = aprende el ruido de fondo
staff-reason-quiet = silencio
staff-reason-voiced = voz o música
staff-reason-other-sound = no parece un soplo
staff-reason-pending = quizá un soplo
staff-reason-blow = soplo
staff-reason-masked = sonido propio del quiosco
staff-reason-fault = muestras erróneas
staff-wind-force = fuerza del viento
staff-attract = demostración
staff-attract-playing = en curso
staff-attract-waiting = en espera
staff-joint-error = error de las uniones
staff-energy = energía
staff-substeps = subpasos
staff-impacts = impactos
staff-faults = fallos
staff-step = paso
staff-step-time = { $ms } ms de { $limit } ms
staff-motion = movimiento
staff-motion-changes = { $count ->
    [one] { $mode }, { $count } cambio
   *[other] { $mode }, { $count } cambios
}
staff-motion-dynamics = dinámica con restricciones
staff-motion-procedural = procedural
staff-motion-position-based = por posiciones
staff-pointer-grabs = sujeto con la mano
staff-steps-dropped = pasos omitidos
staff-commands-dropped = órdenes perdidas
staff-picture = imagen
staff-wind-to-picture = del viento a la imagen
staff-graphics = gráficos
staff-loudspeaker = altavoz
staff-hearing-loop = bucle magnético
staff-step-to-sound = del paso al sonido
staff-sound-delay = { $total } ms: paso { $step }, bloque { $block }, limitador { $limiter }, dispositivo { $device }
staff-sound-delay-unknown = { $total } ms: paso { $step }, bloque { $block }, limitador { $limiter }, dispositivo desconocido
staff-block = bloque
staff-block-is = { $ms } ms, configurados { $wanted } ms
staff-block-shorter = { $ms } ms, configurados { $wanted } ms; audio.block_ms = { $possible } es posible aquí
staff-block-shortest = { $ms } ms, configurados { $wanted } ms; el más corto del dispositivo es { $shortest } ms
staff-late-blocks = bloques tardíos
staff-sounds-lost = sonidos perdidos
staff-volume = volumen
staff-volume-is = { $db } dB, pasos de los visitantes { $steps }
staff-volume-attenuated = { $volume }, atenuado { $db } dB
staff-volume-muted = { $volume }, silenciado
staff-sound-of-the = modo de sonido
staff-sound-day = día
staff-sound-night = noche
staff-sound-by-hours = { $mode }, según el horario
staff-sound-by-staff = { $mode }, por el personal
staff-level-minute = nivel, minuto
staff-level-day = nivel, día
staff-level-calibrated = { $db } dB(A)
staff-level-uncalibrated = { $db } dB(A) a plena escala, sin calibrar
staff-level-silent = silencio

## Staff: exhibits

staff-exhibits-order = Los visitantes encuentran las obras en este orden.
staff-save-order = Guardar el orden
staff-discard = Descartar
staff-no-file = La configuración está integrada: sin un archivo no se puede guardar nada.
staff-others = todas las demás
staff-others-count = todas las demás ({ $count })
staff-exhibit-missing = { $id } (no está o no se carga: vea el registro)
staff-not-listed = Fuera de la lista:

## Staff: bodies and joints

staff-largest-joint-error = mayor error de una unión
staff-no-data-yet = Aún no hay datos de la simulación
staff-joints = Uniones; pulse una para ver su curva
staff-column-body = cuerpo
staff-column-mass = masa, g
staff-column-speed = velocidad, m/s
staff-column-spin = giro, rad/s
staff-column-height = altura, m

## Staff: wind

staff-wind-help = Cada punto es un trozo de superficie que siente el viento. Un anillo marca los trozos dentro del cono del soplo tal como apunta ahora y visibles desde los labios. Cuanto más rojo, más rápido el aire.
staff-column-surface = superficie de
staff-column-hit = alcanzados
staff-column-mean = media, m/s
staff-column-fastest = máxima, m/s
staff-hit-of = { $hit } de { $count }
staff-total-force = fuerza total del viento: { $newtons } N
staff-source-speed = soplo en su origen: { $speed } m/s

## Staff: sound

staff-nothing-audible = No se oirá nada: sonido silenciado o sin altavoz
staff-strike-speed = velocidad del golpe, m/s
staff-pan = izquierda … derecha
staff-all-timbres = Todos los timbres, cada uno en su cuerpo de prueba

## Staff: parameters

staff-does-not-load = El archivo guardado no se carga; se muestra la última versión válida. Deshaga el cambio o corríjalo:
staff-parameters-help = { $file }. Arrastre un número, o púlselo y escriba; se guarda al soltar.
staff-undo = Deshacer ({ $count })
staff-undone = Deshecho.
staff-find = buscar
staff-saved-value = Guardado: { $value }.

## Staff: microphone

staff-no-signal-from = Sin señal; { $device }
staff-level-now = nivel actual
staff-level-range = desde que se abrió la página
staff-from-to = de { $low } a { $high } dBFS
staff-noise-floor = ruido de fondo
staff-breath-at-lips = soplo en los labios
staff-microphones = micrófonos
staff-all-well = Nada que corregir.
staff-measure-again = Medir de nuevo el intervalo
staff-sensitivity = breath.sensitivity_db: cuánto cuenta un soplo
staff-calibrate = Calibrar con un soplo
staff-calibrate-blow = { $count ->
    [one] Desde el lugar de los visitantes, sople al micrófono como ellos durante uno o dos segundos, una vez más.
   *[other] Desde el lugar de los visitantes, sople al micrófono como ellos durante uno o dos segundos, { $count } veces más.
}
staff-stop = Parar
staff-calibrated = Si eran soplos normales: { $proposed } dB en lugar de { $now } dB.
staff-apply = Aplicar
staff-dismiss = Ignorar
staff-remedy-gain-control = Desactive la ganancia automática: en el mezclador del sistema («Auto Gain», «AGC»), en el programa del micrófono o en el dispositivo.
staff-remedy-clipping = Satura: baje la ganancia de entrada.
staff-remedy-muted = Está silenciado: abra la entrada en el mezclador del sistema.
staff-remedy-loud = Alto para una sala tranquila: baje la ganancia de entrada.

## Staff: test

staff-glass = Pantalla táctil
staff-glass-help = { $count ->
    [one] Pulse la imagen con uno o varios dedos: un anillo sigue a cada uno. Ahora: { $count } dedo.
   *[other] Pulse la imagen con uno o varios dedos: un anillo sigue a cada uno. Ahora: { $count } dedos.
}
staff-clear-traces = Borrar los trazos
staff-display = Pantalla
staff-display-help = Niveles de gris, bordes y después colores que revelan píxeles muertos. Cada pulsación muestra la imagen siguiente.
staff-show-patterns = Mostrar las imágenes de prueba
staff-loudspeakers = Altavoces
staff-left = Izquierdo
staff-both = Ambos
staff-right = Derecho
staff-decision = decisión
staff-decision-breath = soplo
staff-decision-none = sin soplo
staff-because = motivo
staff-confidence = certeza
staff-speed = velocidad
staff-grey-steps = 17 niveles uniformes; se ven cinco cuadrados en el negro y en el blanco
staff-edges = una línea blanca de un píxel en los cuatro bordes; cinco círculos redondos

## Staff: log

staff-log-grave = solo avisos y errores
staff-log-empty = ninguna línea
