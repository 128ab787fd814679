# shellcheck shell=bash disable=SC2034
# The parts of the live proof, in the order in which lanes.sh begins them: beside the two that take longest the ones that
# listen, each the only one of its kind meanwhile; then the others. Sourced by run.sh and lanes.sh.
live_parts=(latency every_screen staff_pages reads_aloud own_voice a_visitor doctor_blow
    crash_loop privacy speaker_replugged devices_out replugged killed monitor_off broker clock_set
    config_broken disk_full gpu_lost no_devices compositor no_display one_run)

# Those that wait for what they look for, however long a slow machine takes. The bars of all others are seconds or hundredths
# of them, so they get the processor first.
patient_parts=(every_screen staff_pages privacy broker clock_set disk_full no_devices no_display one_run)

# Those that point at no place of the picture have a display of a quarter of the pixels.
small_parts=(latency doctor_blow crash_loop privacy speaker_replugged devices_out replugged killed broker clock_set config_broken
    disk_full gpu_lost no_display)
