// Runs the page's script, which stands in it packed.
// SPDX-License-Identifier: Apache-2.0
import { failed, unpacked } from "./packed.js";

unpacked("script").then((text) => {
  const script = document.createElement("script");
  script.textContent = text;
  document.body.append(script);
}, failed);
