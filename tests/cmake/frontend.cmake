if(TARGET glint::frontend)
  glint_test(unit_frontend FOLDER unit/frontend LINKS glint::frontend glint::core)
endif()
