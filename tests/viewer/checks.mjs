// What every report must show and do.
import assert from 'node:assert/strict';

const PANELS = ['summary', 'map', 'reasons', 'table', 'scores', 'heat', 'residuals', 'errors',
  'spectrum', 'decay', 'rounds', 'options'];

const text = (page, selector) => page.$eval(selector, (element) => element.textContent);
const settle = (page) =>
  page.evaluate(() => new Promise((done) => {
    requestAnimationFrame(() => requestAnimationFrame(done));
  }));

/** Panels have a heading and something to see below it; those without content are left out. */
export async function checkPanels(page) {
  const found = await page.$$eval('[data-panel]', (panels) =>
    panels.map((panel) => ({
      name: panel.dataset.panel,
      full: panel.children.length > 1 && panel.innerText.trim() !== '',
    })),
  );
  const names = found.map(({ name }) => name);
  assert.deepEqual(names, PANELS.filter((name) => names.includes(name)), 'in their order');
  for (const name of ['summary', 'map', 'options']) assert.ok(names.includes(name), name);
  for (const { name, full } of found) assert.ok(full, `panel ${name} is empty`);
  assert.equal(await page.$$eval('.panel > .absent', (all) => all.length), 0);
}

/** How many pixels of a map are drawn on, or how many lines where it is SVG. */
export async function ink(page, map = 0) {
  await settle(page);
  return page.evaluate((which) => {
    const stage = document.querySelectorAll('.stage')[which];
    const canvas = stage.querySelector('canvas');
    if (!canvas) {
      return [...stage.querySelectorAll('path')]
        .reduce((sum, path) => sum + path.getAttribute('d').split('M').length - 1, 0);
    }
    const copy = document.createElement('canvas');
    [copy.width, copy.height] = [canvas.width, canvas.height];
    const context = copy.getContext('2d');
    context.drawImage(canvas, 0, 0);
    const { data } = context.getImageData(0, 0, copy.width, copy.height);
    let drawn = 0;
    for (let k = 3; k < data.length; k += 4) if (data[k] > 0) ++drawn;
    return drawn;
  }, map);
}

/** What the first map tells at the pointer, and what about. */
const tooltip = (page) =>
  page.$eval('.stage .tooltip', (tip) => ({
    text: tip.hidden ? '' : tip.textContent,
    about: tip.hidden ? '' : tip.dataset.about,
  }));

/** Moves the pointer over the map until it meets an edge; where, and what the map says. */
export async function findEdge(page) {
  const stage = await page.$('.stage');
  await stage.scrollIntoView();
  const box = await stage.boundingBox();
  for (let row = 1; row < 20; ++row) {
    for (let column = 1; column < 30; ++column) {
      const [x, y] = [box.x + (column * box.width) / 30, box.y + (row * box.height) / 20];
      await page.mouse.move(x, y);
      const said = await tooltip(page);
      if (said.about.includes('edge')) return { x, y, said: said.text };
    }
  }
  assert.fail('the pointer met no edge on the map');
}

/** A click on an edge of the map shows its row and its reasons. */
export async function checkClick(page) {
  const { x, y, said } = await findEdge(page);
  await page.mouse.click(x, y);
  await settle(page);
  const names = said.slice(said.indexOf(' ') + 1, said.indexOf(':'));
  const reasons = await text(page, '#reasons dl');
  assert.ok(reasons.includes(names), `${reasons} is not about ${names}`);
  for (const fact of ['In the file', 'Verdict', 'Score', 'Decided', 'Conflicts with']) {
    assert.ok(reasons.includes(fact), `no ${fact} in ${reasons}`);
  }
  const chosen = await page.$eval('.rows .chosen', (row) => {
    const [box, grid] = [row.getBoundingClientRect(), row.closest('.grid').getBoundingClientRect()];
    return {
      ends: [1, 2].map((k) => row.children[k].textContent).join(' – '),
      inSight: box.top >= grid.top && box.bottom <= grid.bottom,
    };
  });
  assert.deepEqual(chosen, { ends: names, inSight: true });
}

/** The pointer is told the numbers of an edge, and of a node where it meets one. */
export async function checkHover(page) {
  const { x, y, said } = await findEdge(page);
  assert.match(said, /^\w+ .+ – .+: (keep|prune|ambiguous), .+\nscore: /);
  // An edge has a node at its end: along the rows of the map there is one.
  const box = await (await page.$('.stage')).boundingBox();
  for (let left = x; left < box.x + box.width; left += 3) {
    await page.mouse.move(left, y);
    const { text: told, about } = await tooltip(page);
    if (!about.includes('node')) continue;
    assert.match(told, /(^|\n)\w+ .+: \(.+, .+\)/);
    return;
  }
  for (let top = box.y; top < box.y + box.height; top += 5) {
    for (let left = box.x; left < box.x + box.width; left += 5) {
      await page.mouse.move(left, top);
      if ((await tooltip(page)).about.includes('node')) return;
    }
  }
  assert.fail('the pointer met no node');
}

/** Every chart tells values under the pointer. */
export async function checkChartHover(page) {
  const charts = await page.$$('.chart');
  assert.ok(charts.length > 0);
  for (const chart of charts) {
    await chart.scrollIntoView();
    await settle(page);
    const box = await (await chart.$('.u-over')).boundingBox();
    const told = await findValue(page, chart, box);
    assert.match(told, /\d/, `nothing told by ${await chart.evaluate((e) => e.ariaLabel)}`);
  }
}

async function findValue(page, chart, box) {
  for (let row = 1; row < 16; ++row) {
    for (let column = 1; column < 24; ++column) {
      await page.mouse.move(box.x + (column * box.width) / 24, box.y + (row * box.height) / 16);
      const said = await chart.$eval('.tooltip', (tip) => (tip.hidden ? '' : tip.textContent));
      if (said !== '') return said;
    }
  }
  return '';
}

/** A link leads from a pruned candidate to one that contradicts it, and from that back. */
export async function checkConflictLinks(page) {
  const names = () => page.$eval('#reasons dl dd', (ends) => ends.textContent);
  const count = await page.$eval('.grid', (grid) => Number(grid.getAttribute('aria-rowcount')) - 1);
  await page.evaluate(() => document.activeElement?.blur());
  for (let k = 0; k < count && !(await page.$('#reasons .link')); ++k) await page.keyboard.press('n');
  const first = await names();
  const link = await page.$('#reasons .link');
  const other = await link.evaluate((button) => button.textContent);
  await link.click();
  assert.equal(await names(), other);
  const back = await page.$$eval('#reasons .link', (all) => all.map((button) => button.textContent));
  assert.ok(back.includes(first), `${back} does not lead back to ${first}`);
  await page.keyboard.press('Escape');
}

/** Filters and sorting of the table do what they say. */
export async function checkTable(page) {
  const [keep, prune, ambiguous] = await page.$$eval('.filters label', (labels) =>
    labels.map((label) => Number(/\((.*)\)/.exec(label.textContent)[1].replaceAll(',', ''))),
  );
  const total = keep + prune + ambiguous;
  const rows = () => page.$eval('.grid', (grid) => Number(grid.getAttribute('aria-rowcount')) - 1);
  assert.equal(await rows(), total);
  await page.click('[data-filter="keep"]');
  assert.equal(await rows(), total - keep);
  await page.click('[data-filter="prune"]');
  assert.equal(await rows(), total - keep - prune);
  await page.click('[data-filter="keep"]');
  await page.click('[data-filter="prune"]');
  await page.type('[data-filter="text"]', 'prune');
  assert.equal(await rows(), prune);
  await page.$eval('[data-filter="text"]', (input) => {
    input.value = '';
    input.dispatchEvent(new Event('input'));
  });
  assert.equal(await rows(), total);

  // A chosen row would be kept in sight.
  await page.focus('.stage');
  await page.keyboard.press('Escape');
  const score = await page.evaluateHandle(() =>
    [...document.querySelectorAll('[role="columnheader"]')]
      .find((head) => head.textContent === 'score'),
  );
  const direction = () => score.evaluate((head) => head.getAttribute('aria-sort'));
  const top = () => page.$eval('.rows [data-candidate]', (row) => row.children[5].textContent);
  await (await score.$('button')).click();
  assert.equal(await direction(), 'ascending');
  const least = await top();
  await (await score.$('button')).click();
  assert.equal(await direction(), 'descending');
  assert.notEqual(await top(), least);
}

/** The map that is the result is drawn without pruned loops until they are asked for. */
export async function checkPrunedSwitch(page) {
  const before = await ink(page, 1);
  await page.click('[data-layer="after:prune"]');
  assert.ok((await ink(page, 1)) > before);
  await page.click('[data-layer="after:prune"]');
  assert.equal(await ink(page, 1), before);
}

/** N and P step through candidates wherever the focus is. */
export async function checkSteps(page) {
  const chosen = () => page.$eval('#reasons', (panel) => panel.textContent);
  await page.evaluate(() => document.activeElement?.blur());
  await page.keyboard.press('n');
  const first = await chosen();
  await page.keyboard.press('n');
  assert.notEqual(await chosen(), first);
  await page.keyboard.press('p');
  assert.equal(await chosen(), first);
  for (const place of ['.stage', '.grid', '[data-layer]', '[data-filter=keep]', '#theme',
    '.head button', '[data-save]', '.buttons button', '.scroll']) {
    const before = await chosen();
    await page.focus(place);
    await page.keyboard.press('n');
    assert.notEqual(await chosen(), before, `N does nothing at ${place}`);
    await page.focus(place);
    await page.keyboard.press('p');
    assert.equal(await chosen(), before, `P does nothing at ${place}`);
  }
  // Where text is written they are letters.
  await page.focus('[data-filter=text]');
  await page.keyboard.press('n');
  assert.equal(await page.$eval('[data-filter=text]', (input) => input.value), 'n');
  await page.keyboard.press('Backspace');
  await page.focus('.stage');
  await page.keyboard.press('Escape');
}

/** On a phone a row begins with the verdict, all of which is in sight. */
export async function checkVerdictInSight(page) {
  const [verdict, others, edge] = await page.evaluate(() => {
    const left = (element) => element.getBoundingClientRect().left;
    const cell = document.querySelector('.rows .col-verdict');
    const rest = [...cell.parentElement.children].filter((element) => element !== cell).map(left);
    return [cell.getBoundingClientRect().right, Math.min(...rest), window.innerWidth];
  });
  assert.ok(verdict <= others && verdict < edge, `${verdict}, ${others}, ${edge}`);
}

/** Switching a layer off takes it from the map, and on brings it back. */
export async function checkLayers(page) {
  const before = await ink(page);
  await page.click('[data-layer="prune"]');
  const without = await ink(page);
  await page.click('[data-layer="prune"]');
  assert.ok(without < before, `${without} drawn without the pruned, ${before} with them`);
  assert.equal(await ink(page), before);
}

/** Everything can be reached and used without a pointer. */
export async function checkKeyboard(page) {
  // The Tab key goes on from where the last click was: from the top of the page.
  await page.evaluate(() => {
    document.activeElement?.blur();
    window.scrollTo(0, 0);
  });
  await page.mouse.click(2, 2);
  const reached = new Set();
  for (let k = 0; k < 80 && !reached.has('rows'); ++k) {
    await page.keyboard.press('Tab');
    const where = await page.evaluate(() => {
      const { classList, dataset } = document.activeElement;
      if (classList.contains('stage')) return 'map';
      if (classList.contains('grid')) return 'rows';
      return dataset.layer ? 'layer' : dataset.filter ? 'filter' : 'other';
    });
    if (where === 'map' && !reached.has('map')) await checkMapKeys(page);
    reached.add(where);
  }
  assert.deepEqual(['filter', 'layer', 'map', 'rows'].filter((place) => !reached.has(place)), []);
  const chosen = () => page.$eval('.rows .chosen', (row) => row.getAttribute('aria-rowindex'));
  await page.keyboard.press('Home');
  assert.equal(await chosen(), '2');
  await page.keyboard.press('ArrowDown');
  assert.equal(await chosen(), '3');
  await page.keyboard.press('End');
  const last = await page.$eval('.grid', (grid) => grid.getAttribute('aria-rowcount'));
  assert.equal(await chosen(), last);
}

/** Presses a key, and waits until the map looks otherwise; a busy machine takes its time. */
async function checkKeyChangesMap(page, key) {
  const stage = await page.evaluateHandle(() => document.activeElement);
  // Read in the page: a screenshot resizes the view for a moment, which moves the map too.
  const picture = async () => {
    await settle(page);
    return stage.evaluate((element) => {
      const canvas = element.querySelector('canvas');
      return canvas ? canvas.toDataURL() : element.innerHTML;
    });
  };
  const before = await picture();
  await page.keyboard.press(key);
  for (let tries = 0; tries < 20; ++tries) if ((await picture()) !== before) return;
  assert.fail(`${key} did not change the map`);
}

async function checkMapKeys(page) {
  await checkKeyChangesMap(page, 'ArrowLeft');
  await checkKeyChangesMap(page, '+');
  await page.keyboard.press('0');
  await page.keyboard.press('Escape');
  assert.equal(await page.$('#reasons dl'), null);
  await page.keyboard.press('n');
  assert.ok(await page.$('#reasons dl'), 'N chose nothing');
}

/** Nothing is wider than the page, and no text is cut off by the edge of a panel. */
export async function checkFits(page) {
  const tooWide = await page.evaluate(() => {
    const width = document.documentElement.clientWidth;
    return [...document.querySelectorAll('.panel, .panel h2, .panel h3, .panel dd, .legend, .maps')]
      .filter((element) => element.getBoundingClientRect().right > width + 0.5)
      .map((element) => element.id || element.className || element.tagName);
  });
  assert.deepEqual(tooWide, []);
  const overflow = await page.evaluate(
    () => document.documentElement.scrollWidth - document.documentElement.clientWidth,
  );
  assert.ok(overflow <= 0, `the page scrolls sideways by ${overflow} pixels`);
}
