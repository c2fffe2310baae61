# Constraints of hemi_axi for Quartus. NOT RUN HERE. One clock; virtual pins need no delays.
create_clock -name aclk -period 20.000 [get_ports aclk]
derive_clock_uncertainty
