# Names of languages in the languages, for exhibits with labels in a language in which the kiosk has no texts.

ar = العربية
cs = Čeština
da = Dansk
el = Ελληνικά
fa = فارسی
fi = Suomi
he = עברית
hu = Magyar
nl = Nederlands
no = Norsk
pl = Polski
pt = Português
ru = Русский
sv = Svenska
tr = Türkçe
uk = Українська
ur = اردو
zh = 中文
