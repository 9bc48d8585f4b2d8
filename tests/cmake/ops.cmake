# Adds the oracles of ops with effects, which run every such op of the table on both machines.
file(GLOB op_oracles CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/ops/*.cpp)
glint_test(ops LINKS glint::pipeline SOURCES ${op_oracles})
