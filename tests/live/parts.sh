# shellcheck shell=bash disable=SC2034
# The parts of the live tests, in the order in which lanes.sh starts them. The two longest parts come with those that use the
# microphone, so that only one of these runs at a time; then the others. Sourced by run.sh and lanes.sh.
live_parts=(latency every_screen staff_pages reads_aloud echo_only a_visitor doctor_blow
    crash_loop privacy own_timbre speaker_replugged devices_out replugged killed monitor_off broker broker_encrypted clock_set
    config_broken disk_full gpu_lost no_devices compositor no_display one_run)

# Parts without time limits. The others have limits of seconds or hundredths of a second, so they get the processor first.
patient_parts=(every_screen staff_pages privacy broker broker_encrypted clock_set disk_full no_devices no_display one_run)

# Parts that do not depend on places in the picture; their display has a quarter of the pixels.
small_parts=(latency doctor_blow crash_loop privacy own_timbre speaker_replugged devices_out replugged killed broker broker_encrypted clock_set config_broken
    disk_full gpu_lost no_display)
