# Constraints of hemi_pins for Radiant. NOT RUN HERE. 24 MHz.
create_clock -name clk_i -period 41.667 [get_ports clk_i]
