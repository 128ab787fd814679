# shellcheck shell=bash disable=SC2034
# The parts of the live proof, in each list those that take longest first. Sourced by run.sh and lanes.sh.

# Those that wait for what they look for, however long a slow machine takes.
patient_parts=(every_screen staff_pages privacy broker clock_set disk_full no_devices no_display one_run)
# Those that listen, or whose bars are seconds until a picture or a sound is there: they get the processor first.
prompt_parts=(latency crash_loop replugged speaker_replugged devices_out a_visitor killed monitor_off reads_aloud own_voice
    config_broken compositor gpu_lost doctor_blow)
