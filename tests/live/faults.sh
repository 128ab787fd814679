# Random faults in a row on a running kiosk: it is killed, frozen, unplugged, its files break and are mended, and a broker floods it.
# Sourced by run.sh after robust.sh. The faults are the same ones for the same SOFFIO_LIVE_SEED.
#
# After each fault a picture is back within 4 s; the exhibit on show is one that is offered, never the built-in one; and at the end the
# counters agree with what was done.

# Exhibits on offer; the kiosk sets those aside on which it is killed three times in an hour.
fault_exhibits=(pendulum steel-fish chains twelve-moons universal-joint chain-heavy loose-nail moving-path harp axis-wheel)

faults() { # faults COUNT
    local files=$workdir/faults toml=$workdir/faults.toml port=18980 topic=museum/faults i kind from took slowest kills=0 wrong=0 shown
    local names=(killed frozen unplugged configuration exhibit burst)
    local PATH=$PATH:/usr/sbin
    command -v mosquitto >/dev/null || { cannot "faults" "a broker is missing: apt-get install mosquitto mosquitto-clients"; return; }
    while (exec 3<>"/dev/tcp/127.0.0.1/$port") 2>/dev/null; do port=$((port + 1)); done
    RANDOM=${SOFFIO_LIVE_SEED:-1}
    mkdir -p "$files"
    for i in "${fault_exhibits[@]}"; do cp -r "$root/exhibits/$i" "$files"; done
    good_site() {
        configured "$toml" '[exhibits]\nfolder = "%s"\nshow = ["*"]\n[mqtt]\nbroker = "127.0.0.1:%s"\ntopic = "%s"\nobeys = ["exhibit", "reload"]\n' \
            "$files" "$port" "$topic"
    }
    printf 'listener %s 127.0.0.1\nallow_anonymous true\n' "$port" >"$workdir/faults.conf"
    start faults_broker mosquitto -c "$workdir/faults.conf"
    good_site
    launch_kiosk faults --config "$toml" --no-attract
    within 20 picture || true
    for ((i = 1; i <= $1; i++)); do
        kind=$(below 6)
        from=$(now)
        case $kind in
            0)
                kills=$((kills + 1))
                kill -9 "$(child)"
                within 10 pixels faults $((kills + 1)) || true
                ;;
            1)
                kill -STOP "$(child)"
                sleep "0.$(below 10)"
                kill -CONT "$(child)"
                ;;
            2)
                pull_microphone
                sleep 0.5
                plug_microphone
                ;;
            3)
                printf '[visit]\nbreth = tru\n[[[' >"$toml"
                sleep 1
                good_site
                ;;
            4)
                shown=$(state on_show)
                printf 'broken = [[[' >>"$files/$shown/exhibit.toml"
                sleep 1
                cp "$root/exhibits/$shown/exhibit.toml" "$files/$shown/exhibit.toml"
                ;;
            5)
                for _ in {1..200}; do echo "exhibit ${fault_exhibits[$(below ${#fault_exhibits[@]})]}"; done |
                    mosquitto_pub -h 127.0.0.1 -p "$port" -t "$topic/cmd" -l
                ;;
        esac
        took=$(until_picture "$from")
        # A fault that takes its own time is not the kiosk's.
        [ "$kind" = 0 ] || took=$(awk "BEGIN { print $took - 1.5 }")
        echo "$took ${names[$kind]} $(state on_show)" >>"$workdir/faults.times"
        sleep 1.2
        [[ " ${fault_exhibits[*]} " == *" $(state on_show) "* ]] || wrong=$((wrong + 1))
    done
    slowest=$(sort -n "$workdir/faults.times" | tail -1)
    bar "faults: picture back" "${slowest%% *} < 4" "$slowest: the slowest of $1 faults, $kills kills among them"
    bar "faults: state" "$wrong == 0 && $(state starts) == $kills + 1 && $(grep -c 'built-in' "$workdir/faults.err") == 0" \
        "$(state starts) starts, $wrong times another exhibit than those on offer"
    local code=0
    end_launcher || code=$?
    bar "faults: orderly end" "$code == 130" "exit code $code"
}
