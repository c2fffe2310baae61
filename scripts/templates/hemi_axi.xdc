# Constraints of hemi_axi for Vivado. NOT RUN HERE. One clock; all ports belong to it, so nothing crosses clock domains.
create_clock -name aclk -period 20.000 [get_ports aclk]
set_input_delay -clock aclk 5.000 [get_ports -filter {DIRECTION == IN && NAME != aclk}]
set_output_delay -clock aclk 5.000 [get_ports -filter {DIRECTION == OUT}]
