// Runs the page's script, which stands in it packed.
// SPDX-License-Identifier: Apache-2.0
import { unpackText } from "./inflate.js";

const packed = document.getElementById("packed");
const script = document.createElement("script");
script.textContent = unpackText(packed.textContent, Number(packed.dataset.bytes));
document.body.append(script);
