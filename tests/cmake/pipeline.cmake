glint_test(cosim LINKS glint::pipeline)
glint_test(picture LINKS glint::pipeline glint_reference)
