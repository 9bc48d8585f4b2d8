glint_test(unit_base FOLDER unit/base LINKS glint::base)
