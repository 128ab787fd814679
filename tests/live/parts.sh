# shellcheck shell=bash disable=SC2034
# The parts of the live proof, in the order in which they begin. Sourced by run.sh and lanes.sh.

# Those that listen, or whose bars are seconds until a picture or a sound is there: they get the processor first.
prompt_parts=(a_visitor latency own_voice reads_aloud doctor_blow replugged speaker_replugged devices_out
    compositor killed crash_loop config_broken gpu_lost monitor_off)
# Those that wait for what they look for, however long a slow machine takes. The longest begin.
patient_parts=(staff_pages every_screen broker privacy clock_set disk_full no_devices no_display one_run)
