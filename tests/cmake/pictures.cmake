# Adds tests of picture files.
glint_test(unit_pictures FOLDER unit/pictures LINKS glint::pictures)
