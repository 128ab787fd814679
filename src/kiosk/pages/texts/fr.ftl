# Français

language-name = Français

## What visitors read

invite = Soufflez doucement
hold = Appuyez longuement pour souffler
no-breath = Aujourd’hui, ne soufflez pas : appuyez longuement pour faire du vent
privacy = Le microphone mesure seulement l’air. Rien n’est enregistré.
more = Plus
back = Retour à l’œuvre
aim = Touchez ou pointez : l’anneau montre où va votre souffle
take = Appuyez et tirez pour la déplacer à la main
press-twice = Appuyez pour souffler, appuyez de nouveau pour arrêter
dwell-twice = Immobilisez le pointeur pour souffler ; déplacez-le et immobilisez-le de nouveau pour arrêter
look-round = Tourner autour
look-round-drag = Glissez à côté de l’œuvre pour tourner autour
look-round-press = Appuyez à côté de l’œuvre pour tourner autour
large-text = Grand texte
high-contrast = Contraste élevé
microphone = Microphone
press-once = Un seul appui
dwell = Pointer sans appuyer
less-motion = Moins de mouvement
read-aloud = Lire à voix haute
microphone-off = Le microphone est coupé.
sound-off = Le son est coupé.
no-sound = Cette œuvre est silencieuse.
take-a-rest = Faites une pause et respirez calmement.
stay = Touchez ou soufflez pour continuer
stay-touch = Touchez pour continuer
cleaning = Nettoyage de l’écran en cours

## What is read aloud of buttons that show only a sign

louder = Plus fort
softer = Moins fort
next-page = Œuvres suivantes
previous-page = Œuvres précédentes
on = activé
off = désactivé

## The staff panel: its frame

staff-page-status = État
staff-page-exhibits = Œuvres
staff-page-bodies = Corps
staff-page-wind = Vent
staff-page-sound = Son
staff-page-parameters = Paramètres
staff-page-microphone = Microphone
staff-page-test = Test
staff-page-log = Journal
staff-no-pin = Aucun code PIN n’est défini : ce panneau montre tout et ne change rien. Lancez `soffio pin` et placez la ligne affichée sous [staff].
staff-saved-in = Enregistré dans { $file }.
staff-enter-pin = Personnel : entrez le code PIN
staff-pin-checking = Vérification
staff-pin-wrong = { $count ->
    [one] Code PIN erroné. Nouvel essai dans { $seconds } s.
   *[other] Code PIN erroné, { $count } fois de suite. Nouvel essai dans { $seconds } s.
}

## Staff: status

staff-clean = Nettoyer l’écran
staff-mute = Couper le son
staff-unmute = Rétablir le son
staff-night = Nuit
staff-reset = Réinitialiser
staff-reload = Recharger l’œuvre
staff-open-now = Ouvrir maintenant
staff-close-again = Refermer
staff-audio-self-test = Autotest audio
staff-new-foam = Bonnette neuve
staff-new-reference = Nouvelle référence
staff-end = Arrêter la borne
staff-configuration-says = Configuration : { $message }
staff-microphone-says = Microphone : { $message }
staff-venue = musée
staff-venue-open = ouvert
staff-venue-early = ouvert par le personnel avant l’heure
staff-venue-closed = fermé
staff-breath-wanted = souffle
staff-breath-allowed = autorisé
staff-breath-off = désactivé : les visiteurs appuient longuement
staff-exhibit = œuvre
staff-microphone = microphone
staff-microphone-dual = { $device }, double microphone
staff-device-starting = démarrage
staff-device-ok = { $name }, { $rate } Hz
staff-device-missing = absent : { $reason }
staff-device-closed = fermé
staff-level = niveau
staff-level-floor = { $level } dBFS, bruit de fond { $floor } dBFS
staff-no-signal = aucun signal
staff-clipping = saturation
staff-clips = { $count ->
    [one] { $count } fois, dont { $without } sans souffle
   *[other] { $count } fois, dont { $without } sans souffle
}
staff-foam = bonnette
staff-foam-breaths = { $count ->
    [one] { $count } souffle
   *[other] { $count } souffles
}
staff-foam-breaths-of = { $count } sur { $limit ->
    [one] { $limit } souffle
   *[other] { $limit } souffles
}
staff-self-test = autotest audio
staff-self-test-none = pas encore effectué
staff-self-test-when = { $verdict } ; { $when }
staff-self-test-good = bonnette, haut-parleur et microphone inchangés ({ $db } dB)
staff-self-test-learning = mesure de référence { $number } sur { $count }
staff-self-test-wet-foam = bonnette humide ou poussiéreuse : les aigus sont plus faibles de { $db } dB. Changez-la.
staff-self-test-blocked = tout est plus faible de { $db } dB : vérifiez la bonnette, les obstacles et les gains
staff-self-test-louder = tout est plus fort de { $db } dB : un gain a été augmenté. Si c’est voulu, appuyez sur « Nouvelle référence ».
staff-self-test-dead = aucun signal du microphone : vérifiez son câble, son interrupteur et son alimentation
staff-self-test-not-detected = le son de test n’est pas arrivé : vérifiez le haut-parleur et son amplificateur
staff-self-test-noisy = la salle était trop bruyante pour mesurer
staff-self-test-failed = non effectué : { $reason }
staff-gain-control = gain automatique
staff-gain-control-detected = détecté
staff-gain-control-none = non détecté
staff-heard = ici le détecteur entend
staff-heard-of = { $detected } souffles sur { $of } à { $distance } cm
staff-heard-unknown = non mesuré : enregistrer dix souffles, puis soffio breath fit
staff-gusts = courants d’air et portes
staff-gusts-cost = coûtent { $db } dB à un souffle
staff-detector = détecteur
staff-detector-state = { $reason }, { $confidence }
staff-breath = souffle
staff-breath-speeds = { $detected } m/s détectés, { $blown } m/s dans l’air
staff-reason-no-signal = aucun signal
staff-reason-settling = apprend le bruit de fond
staff-reason-quiet = calme
staff-reason-voiced = voix ou musique
staff-reason-other-sound = ne ressemble pas à un souffle
staff-reason-pending = peut-être un souffle
staff-reason-blow = souffle
staff-reason-masked = son propre de la borne
staff-reason-fault = échantillons erronés
staff-wind-force = force du vent
staff-attract = démonstration
staff-attract-playing = en cours
staff-attract-waiting = en attente
staff-joint-error = écart des liaisons
staff-energy = énergie
staff-substeps = sous-pas
staff-impacts = chocs
staff-faults = fautes
staff-step = pas
staff-step-time = { $ms } ms sur { $limit } ms
staff-motion = mouvement
staff-motion-changes = { $count ->
    [one] { $mode }, { $count } changement
   *[other] { $mode }, { $count } changements
}
staff-motion-dynamics = dynamique sous contraintes
staff-motion-procedural = procédural
staff-motion-position-based = par positions
staff-pointer-grabs = tenu à la main
staff-steps-dropped = pas sautés
staff-commands-dropped = commandes perdues
staff-picture = image
staff-wind-to-picture = du vent à l’image
staff-graphics = carte graphique
staff-loudspeaker = haut-parleur
staff-hearing-loop = boucle magnétique
staff-step-to-sound = du pas au son
staff-sound-delay = { $total } ms : pas { $step }, bloc { $block }, limiteur { $limiter }, appareil { $device }
staff-sound-delay-unknown = { $total } ms : pas { $step }, bloc { $block }, limiteur { $limiter }, appareil inconnu
staff-block = bloc
staff-block-is = { $ms } ms, { $wanted } ms configurés
staff-block-shorter = { $ms } ms, { $wanted } ms configurés ; audio.block_ms = { $possible } est possible ici
staff-block-shortest = { $ms } ms, { $wanted } ms configurés ; le plus court de l’appareil est { $shortest } ms
staff-late-blocks = blocs en retard
staff-sounds-lost = sons perdus
staff-volume = volume
staff-volume-is = { $db } dB, crans des visiteurs { $steps }
staff-volume-attenuated = { $volume }, atténué de { $db } dB
staff-volume-muted = { $volume }, coupé
staff-sound-of-the = mode sonore
staff-sound-day = jour
staff-sound-night = nuit
staff-sound-by-hours = { $mode }, selon l’horaire
staff-sound-by-staff = { $mode }, par le personnel
staff-level-minute = niveau, minute
staff-level-day = niveau, jour
staff-level-calibrated = { $db } dB(A)
staff-level-uncalibrated = { $db } dB(A) pleine échelle, non étalonné
staff-level-silent = silence

## Staff: exhibits

staff-exhibits-order = Les visiteurs trouvent les œuvres dans cet ordre.
staff-save-order = Enregistrer l’ordre
staff-discard = Annuler
staff-no-file = La configuration est intégrée : sans fichier, rien ne peut être enregistré.
staff-others = toutes les autres
staff-others-count = toutes les autres ({ $count })
staff-exhibit-missing = { $id } (absente ou impossible à charger : voir le journal)
staff-not-listed = Absentes de la liste :

## Staff: bodies and joints

staff-largest-joint-error = plus grand écart d’une liaison
staff-no-data-yet = Pas encore de données de la simulation
staff-joints = Liaisons ; appuyez sur l’une pour voir sa courbe
staff-column-body = corps
staff-column-mass = masse, g
staff-column-speed = vitesse, m/s
staff-column-spin = rotation, rad/s
staff-column-height = hauteur, m

## Staff: wind

staff-wind-help = Chaque point est un morceau de surface sensible au vent. Un anneau marque les morceaux situés dans le cône du souffle tel qu’il vise et visibles depuis les lèvres. Plus c’est rouge, plus l’air est rapide.
staff-column-surface = surface de
staff-column-hit = touchés
staff-column-mean = moyenne, m/s
staff-column-fastest = maximum, m/s
staff-hit-of = { $hit } sur { $count }
staff-total-force = force totale du vent : { $newtons } N
staff-source-speed = souffle à sa source : { $speed } m/s

## Staff: sound

staff-nothing-audible = Rien ne sera audible : son coupé, ou aucun haut-parleur
staff-strike-speed = vitesse de frappe, m/s
staff-pan = gauche … droite
staff-all-timbres = Tous les timbres, chacun sur son corps d’essai

## Staff: parameters

staff-does-not-load = Le fichier enregistré ne se charge pas ; la dernière bonne version est affichée. Annulez la modification ou corrigez-la :
staff-parameters-help = { $file }. Glissez un nombre, ou appuyez dessus et tapez ; il est enregistré quand vous relâchez.
staff-undo = Annuler ({ $count })
staff-undone = Annulé.
staff-find = chercher
staff-saved-value = Enregistré : { $value }.

## Staff: microphone

staff-no-signal-from = Aucun signal ; { $device }
staff-level-now = niveau actuel
staff-level-range = depuis l’ouverture de la page
staff-from-to = { $low } à { $high } dBFS
staff-noise-floor = bruit de fond
staff-breath-at-lips = souffle aux lèvres
staff-microphones = microphones
staff-all-well = Rien à corriger.
staff-measure-again = Mesurer de nouveau la plage
staff-sensitivity = breath.sensitivity_db : importance donnée à un souffle
staff-calibrate = Étalonner avec un souffle
staff-calibrate-blow = { $count ->
    [one] Depuis la place des visiteurs, soufflez vers le microphone comme eux pendant une à deux secondes, encore une fois.
   *[other] Depuis la place des visiteurs, soufflez vers le microphone comme eux pendant une à deux secondes, encore { $count } fois.
}
staff-stop = Arrêter
staff-calibrated = Si c’étaient des souffles normaux : { $proposed } dB au lieu de { $now } dB.
staff-apply = Appliquer
staff-dismiss = Ignorer
staff-remedy-gain-control = Désactivez le gain automatique : dans le mélangeur du système (« Auto Gain », « AGC »), dans le logiciel du microphone ou sur l’appareil.
staff-remedy-clipping = Il sature : baissez le gain d’entrée.
staff-remedy-muted = Il est coupé : ouvrez l’entrée dans le mélangeur du système.
staff-remedy-loud = Fort pour une salle calme : baissez le gain d’entrée.

## Staff: test

staff-glass = Écran tactile
staff-glass-help = { $count ->
    [one] Appuyez sur l’image avec un ou plusieurs doigts : un anneau suit chacun. Maintenant : { $count } doigt.
   *[other] Appuyez sur l’image avec un ou plusieurs doigts : un anneau suit chacun. Maintenant : { $count } doigts.
}
staff-clear-traces = Effacer les traces
staff-display = Affichage
staff-display-help = Niveaux de gris, bords, puis couleurs qui révèlent les pixels morts. Chaque appui montre l’image suivante.
staff-show-patterns = Montrer les mires
staff-loudspeakers = Haut-parleurs
staff-left = Gauche
staff-both = Les deux
staff-right = Droite
staff-decision = décision
staff-decision-breath = souffle
staff-decision-none = pas de souffle
staff-because = raison
staff-confidence = confiance
staff-speed = vitesse
staff-grey-steps = 17 niveaux réguliers ; cinq carrés sont visibles dans le noir et dans le blanc
staff-edges = une ligne blanche d’un pixel sur les quatre bords ; cinq cercles ronds

## Staff: log

staff-log-grave = seulement les avertissements et les erreurs
staff-log-empty = aucune ligne
