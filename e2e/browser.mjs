// What the tests of the page share: a browser, pages whose console is kept, and the count of failures.

import path from 'node:path';
import { createRequire } from 'node:module';

const require = createRequire(path.join(import.meta.dirname, '.tools', 'here.js'));
const { chromium } = require('playwright-core');
const FLAGS = ['--no-sandbox', '--disable-quic', '--no-first-run', '--disable-background-networking', '--disable-component-update', '--disable-sync'];
const SOFTWARE = ['--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist'];

let failures = 0;

export const launch = () => chromium.launch({ executablePath: '/usr/bin/chromium', args: [...FLAGS, ...SOFTWARE] });

export function check(what, holds, detail = '') {
  if (!holds) failures += 1;
  console.log(`${holds ? 'ok  ' : 'FAIL'} ${what}${holds || detail === '' ? '' : `: ${detail}`}`);
}

// waits for a condition inside the page, at most 15 s; by the clock, as a slow picture would make the asking slow
export async function until(what, page, condition, argument) {
  try {
    await page.waitForFunction(condition, argument, { timeout: 60000, polling: 100 });
    check(what, true);
  } catch (error) {
    check(what, false, error.message.split('\n')[0]);
  }
}

// opens a page and keeps every word of its console
export async function open(browser, url, options = {}) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 800 }, reducedMotion: 'reduce', acceptDownloads: true, ...options });
  const page = await context.newPage();
  page.said = [];
  page.on('console', (message) => page.said.push(`${message.type()}: ${message.text()}`));
  page.on('pageerror', (error) => page.said.push(`error: ${error.message}`));
  page.on('request', (request) => {
    if (!/^(file|data|blob|ws|http:\/\/127)/.test(request.url())) page.said.push(`asked for ${request.url()}`);
  });
  await page.goto(url);
  return page;
}

export async function quiet(what, page) {
  check(`${what}: the console is silent`, page.said.length === 0, page.said.slice(0, 5).join(' | '));
  await page.context().close();
}

// the last word, and the exit status
export function finish() {
  console.log(failures === 0 ? '\nall is well' : `\n${failures} failed`);
  process.exit(failures === 0 ? 0 : 1);
}
