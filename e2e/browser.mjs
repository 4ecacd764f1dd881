// Shared by the tests of the page: starts the browser, records console messages, counts failures.

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

// Waits up to 60 s for a condition in the page. It polls by the clock: software rendering makes animation frames slow.
export async function until(what, page, condition, argument) {
  try {
    await page.waitForFunction(condition, argument, { timeout: 60000, polling: 100 });
    check(what, true);
  } catch (error) {
    check(what, false, error.message.split('\n')[0]);
  }
}

// opens a page and records its console messages, errors and requests to other servers in `page.messages`
export async function open(browser, url, options = {}) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 800 }, reducedMotion: 'reduce', acceptDownloads: true, ...options });
  const page = await context.newPage();
  page.messages = [];
  page.on('console', (message) => page.messages.push(`${message.type()}: ${message.text()}`));
  page.on('pageerror', (error) => page.messages.push(`error: ${error.message}`));
  page.on('request', (request) => {
    if (!/^(file|data|blob|ws|http:\/\/127)/.test(request.url())) page.messages.push(`request to ${request.url()}`);
  });
  await page.goto(url);
  return page;
}

// checks that nothing was recorded, and closes the page
export async function closeSilent(what, page) {
  check(`${what}: no console messages`, page.messages.length === 0, page.messages.slice(0, 5).join(' | '));
  await page.context().close();
}

// prints the result and exits
export function finish() {
  console.log(failures === 0 ? '\nall checks passed' : `\n${failures} failed`);
  process.exit(failures === 0 ? 0 : 1);
}
