# All of a verilated model's sources in one file, whose name is known before Verilator has run.
file(GLOB parts RELATIVE ${DIRECTORY} ${DIRECTORY}/${PREFIX}*.cpp)
list(REMOVE_ITEM parts ${PREFIX}__ALL.cpp)
list(SORT parts)
set(text "// Generated.\n")
foreach(part ${parts})
  string(APPEND text "#include \"${part}\"\n")
endforeach()
file(WRITE ${DIRECTORY}/${PREFIX}__ALL.cpp "${text}")
