if(TARGET glint::amber)
  glint_test(amber LINKS glint::amber)
endif()
