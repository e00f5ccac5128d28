/** The layers' colours, which the canvas carries as colours that it has no use for itself (sheet.js). */

/** @param {HTMLElement} element @param {HTMLElement} canvas @returns {Partial<import('../viewer.js').LayerColors>} */
export function themeOf(element, canvas) {
  const { color, caretColor, columnRuleColor } = getComputedStyle(canvas);
  const asked = getComputedStyle(element).getPropertyValue('--point-weave-mesh');
  return { mesh: color, points: caretColor, reduced: columnRuleColor, plain: asked ? color : '#ffffff' };
}
